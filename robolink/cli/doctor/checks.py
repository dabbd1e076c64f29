"""Checks of this machine and its network for `robolink doctor`: pure functions of the facts."""

from __future__ import annotations

import re

from robolink.cli.doctor.facts import Check, ClockOffset, Facts, Verdict, count, listed
from robolink.networks.port_probe import REFUSES, ROUTER, SILENT, Port
from robolink.networks.refusals import HAS_NO_KEYS, WANTS_KEYS
from robolink.networks.request import NETWORK
from robolink.transport.reach import on_this_machine
from robolink.transport.shared_memory import VARIABLE, decide
from robolink.wire import NodeToken

OLDEST_PYTHON = (3, 10)
OLDEST_ZENOH = (1, 10)
FIRST_FOR_NUMPY_2 = (4, 10)
"""First version of OpenCV whose wheels were built for numpy 2."""

LATE, WRONG = 0.1, 1.0
"""Offsets of two clocks, in seconds, from which transforms are disturbed and impossible."""

_NO_EFFECT = {
    "ROS_LOCALHOST_ONLY": "say ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST, which is the default here",
    "ROS_STATIC_PEERS": "say ROBOLINK_NETWORK=HOST to meet another machine",
    "ROS_DISCOVERY_SERVER": "it is DDS's; say ROBOLINK_NETWORK=HOST to meet another machine",
}
_NOTED = (
    *(NETWORK, "ROBOLINK_TRANSPORT", "ROBOLINK_ROS_DISTRO", "ROBOLINK_SHARED_MEMORY"),
    "ROBOLINK_LIMITS",
    *("ZENOH_SESSION_CONFIG_URI", "ZENOH_CONFIG_OVERRIDE", "ROS_AUTOMATIC_DISCOVERY_RANGE"),
    *("ZENOH_RUNTIME", "RUST_LOG"),
)


def versions(facts: Facts) -> Verdict:
    """Check that Python and robolink's dependencies are there and new enough."""
    missing = [name for name, found in facts.versions.items() if not found and name != "robolink"]  # its source may run
    errors = [f"{each} is not installed: pip install {each}" for each in missing]
    if facts.python < OLDEST_PYTHON:
        errors.append(f"Python {_dotted(facts.python)} is too old: robolink needs {_dotted(OLDEST_PYTHON)} or newer")
    zenoh = facts.versions.get("eclipse-zenoh", "")
    if zenoh and _numbers(zenoh) < OLDEST_ZENOH:
        errors.append(f"eclipse-zenoh {zenoh} is too old: pip install -U 'eclipse-zenoh>={_dotted(OLDEST_ZENOH)}'")
    shown = [f"{name} {found}" for name, found in facts.versions.items() if found]
    warnings = tuple(
        f"{each} also installs a module 'robolink', and the one that comes last overwrites the other's: "
        f"give it a virtual environment of its own, here 'pip uninstall {each.split()[0]}' "
        "and install robolink again, with 'pip install --force-reinstall'"
        for each in facts.namesakes
    )
    warnings += facts.extensions
    return Verdict(", ".join([*shown[:1], f"Python {_dotted(facts.python)}", *shown[1:4]]), tuple(errors), warnings)


def opencv(facts: Facts) -> Verdict:
    """Check that OpenCV, if it is installed, is there once, is new enough, and fits numpy."""
    from robolink.image.opencv import OLDEST

    found = facts.opencv
    if not found:
        return Verdict(
            "OpenCV is not installed: only images need it, for JPEG and in programs (pip install opencv-python)"
        )
    names, warnings = " and ".join(found), []
    if len(found) > 1:
        again = f"pip uninstall {' '.join(found)}, then pip install one of them"
        warnings.append(f"{names} overwrite each other's files: {again}")
    for name, version in found.items():
        if _numbers(version) < OLDEST:
            warnings.append(f"{name} {version} is too old for robolink's images: pip install -U {name}")
        if _numbers(version) < FIRST_FOR_NUMPY_2 and _numbers(facts.versions.get("numpy", "")) >= (2,):
            warnings.append(f"{name} {version} does not load with numpy 2: pip install -U {name}, or 'numpy<2'")
    return Verdict(", ".join(f"{name} {version}" for name, version in found.items()), (), tuple(warnings))


def _dotted(version: tuple[int, ...]) -> str:
    return ".".join(map(str, version))


def _numbers(version: str) -> tuple[int, ...]:
    return tuple(int(each) for each in re.findall(r"\d+", version)[:2])


def settings(facts: Facts) -> Verdict:
    """Check that the environment's settings are valid, and that none is without effect."""
    environ, expected = facts.environ, facts.settings
    names = () if expected.whom else _NO_EFFECT  # a network of another kind reads what it does
    without_effect = [each for each in names if environ.get(each, "0") not in ("", "0")]
    warnings = [f"{each}={environ[each][:80]} has no effect: {_NO_EFFECT[each]}" for each in without_effect]
    middleware = environ.get("RMW_IMPLEMENTATION", "")
    if middleware not in ("", "rmw_zenoh_cpp") and not expected.whom:
        warnings.append(
            f"RMW_IMPLEMENTATION={middleware[:80]}: ROS 2 nodes started from here do not meet robolink's; "
            "start them with RMW_IMPLEMENTATION=rmw_zenoh_cpp"
        )
    if expected.transport != "zenoh" and not (expected.whom or expected.errors):
        warnings.append(f"ROBOLINK_TRANSPORT={expected.transport[:80]}: nodes see only their own process")
    said = expected.origin if expected.origin in _NOTED else NETWORK  # which the command line or a launch file sets
    noted = [name for name in _NOTED if environ.get(name) and name != said]
    in_force = [f"{name}={environ[name][:80]}" for name in noted]
    domain = f"domain {expected.domain} ({'ROS_DOMAIN_ID' if environ.get('ROS_DOMAIN_ID') else 'the default'})"
    network = f"network {expected.network} ({expected.origin or 'the default'})"
    return Verdict(", ".join([domain, network, *in_force]), expected.errors, tuple(warnings))


def loopback(facts: Facts) -> Verdict:
    """Check that the machine can connect to itself: that is where nodes meet."""
    if facts.loopback:
        return Verdict("this machine can connect to itself")
    hint = ": try 'ip link set lo up'" if facts.platform == "linux" else ""
    return Verdict("", (f"no connection to 127.0.0.1{hint}",))


def reach(facts: Facts) -> Verdict:
    """Check that a session whose settings lead to other machines has a link there."""
    settings, seen, whom = facts.settings, facts.seen, facts.reach
    if settings.whom and not seen.error:
        return Verdict(f"nodes meet {settings.whom}")
    if settings.transport != "zenoh":
        return Verdict("not used with these settings")
    if seen.error:
        return Verdict(str(whom), unknown=True)
    client = whom.mode == "client"
    if not whom.leaves_machine and not client:
        return Verdict(f"nodes meet {whom}")
    far = [each for each in seen.links if client or each.leaves_machine]
    if not far:
        return Verdict("", (), (_nobody(facts),))
    linked = f"nodes meet {whom}: linked to {count(len({each.session for each in far}), 'session')} there"
    if seen.tokens or seen.other_domains:  # then the domain is what is to be looked at
        return Verdict(linked)
    routed = not client and any(each.role == ROUTER for each in far)
    hint = '; a router of ROS 2 passes things on to its clients only: add mode="client"' if routed else ""
    return Verdict("", (), (f"{linked}, but nobody there has a node{hint}",))


def certificates(facts: Facts) -> Verdict:
    """Check that the certificates of the settings, if there are any, are valid and accepted by the other side."""
    if not facts.reach.secured:
        return Verdict("none are used with these settings")
    return Verdict("sound, and nobody refuses them", facts.certificate_errors, facts.certificate_warnings)


def _nobody(facts: Facts) -> str:
    """Return the warning that no other machine answers, with what to do."""
    settings, whom = facts.settings, facts.reach
    answers = f"network {settings.network[:120]}: no other machine has answered ({whom})"
    if whom.multicast:
        return (
            f"{answers}: start a node there with --network {settings.network[:120]}; if one runs there, multicast does "
            f"not pass between you (Wi-Fi, a VPN, another subnet): here, say --network HOST, that machine's name"
        )
    if all(map(on_this_machine, whom.connects)):
        return f"{answers}: connect to one of this machine's addresses there, and let the port through its firewall"
    return f"{answers}: is it on, and does its firewall let the port through?"


def rendezvous(facts: Facts) -> Verdict:
    """Check that the rendezvous port is free, or held by a node."""
    expected = facts.settings
    if expected.transport != "zenoh" or not expected.meets:
        return Verdict("not used with these settings")
    port = facts.ports.get(expected.port)
    if port is None:
        return Verdict(f"port {expected.port} of domain {expected.domain} is free: the next node takes it")
    held, keyed = f"port {expected.port} of domain {expected.domain} is held by", expected.port in facts.keyed_ports
    if not port.speaks_zenoh and not keyed:
        hint = "stop it, or choose another ROS_DOMAIN_ID"
        return Verdict("", (f"{held} {_stranger(facts, port)}: {hint}",))
    if keyed != facts.reach.secured:
        return Verdict("", (f"{held} {_whose(facts, port)}, {WANTS_KEYS if keyed else HAS_NO_KEYS}",))
    return Verdict(f"{held} {_whose(facts, port)}")


def router(facts: Facts) -> Verdict:
    """Check that a ROS 2 router, if there is one, answers, and so does the one that the settings name."""
    requested, far, port = facts.settings.network, facts.far_router, facts.ports.get(facts.router_port)
    where = f"port {facts.router_port}, the ROS 2 router's,"
    errors, warnings = [], []
    if requested.startswith("tcp/") and far is None:
        errors.append(f"nothing listens at {requested}: start the router there, or unblock the port")
    elif requested.startswith("tcp/") and far is not None and not far.speaks_zenoh:
        errors.append(f"{requested} listens but does not answer as Zenoh does")
    if port is not None and port.number in facts.keyed_ports:
        return _keyed_router(facts, port, tuple(errors))
    if port is not None and port.role != ROUTER:
        errors.append(f"{where} is held by {_stranger(facts, port)}: stop it to meet ROS 2 nodes")
    elif port is not None and facts.platform == "win32" and requested == "localhost":
        hint = f"ROBOLINK_NETWORK=tcp/127.0.0.1:{port.number}"
        warnings.append(f"a ROS 2 router answers; on Windows nodes join it only when asked to: {hint}")
    elif port is not None and not facts.reach.leaves_machine and not facts.reach.secured:
        warnings += _ways_in(facts)
    answers = f"a ROS 2 router answers on port {facts.router_port}: {_whose(facts, port)}" if port else ""
    none = f"no ROS 2 router on port {facts.router_port}: none is needed but to meet ROS 2 nodes"
    return Verdict(answers or none, tuple(errors), tuple(warnings))


def _keyed_router(facts: Facts, port: Port, errors: tuple[str, ...]) -> Verdict:
    """Return the verdict on a router's port that asks for a certificate: only those with keys use it."""
    held = f"port {port.number}, the ROS 2 router's, is held by {_whose(facts, port)}"
    return Verdict(held, errors, () if facts.reach.secured else (f"{held}, {WANTS_KEYS}",))


def _ways_in(facts: Facts) -> list[str]:
    """Return warnings of the ways by which a router lets others hear nodes of this machine."""
    router = f"the router on port {facts.router_port}"
    found = []
    if facts.router_open_at:
        own = f'listen/endpoints=["tcp/127.0.0.1:{facts.router_port}"]'
        found.append(
            f"{router} also listens at {listed(facts.router_open_at)}: through it other machines hear and command your "
            f"nodes; start it with ZENOH_CONFIG_OVERRIDE='{own}' to keep it on this one "
            "(robolink's router: without --listen)"
        )
    if facts.router_owner:
        found.append(f"{router} is another user's, {facts.router_owner}: it hears and may command your nodes")
    return found


def _whose(facts: Facts, port: Port) -> str:
    holder = facts.holders.get(port.number)
    process = f" ({holder.command}, pid {holder.pid})" if holder else ""
    if port.number in facts.keyed_ports:
        return f"a process with security{process}"
    return f"a Zenoh {port.role}{process}" if port.speaks_zenoh else f"a stranger{process}"


def _stranger(facts: Facts, port: Port) -> str:
    """Return a description of what holds a port that should be another's."""
    if port.speaks_zenoh:
        return f"{_whose(facts, port)}, which is not a router"
    says = {REFUSES: "speaks Zenoh but refuses", SILENT: "accepts connections and says nothing, or is frozen"}
    return f"{_whose(facts, port)} that {says.get(port.role, 'does not speak Zenoh')}"


def domains(facts: Facts) -> Verdict:
    """Check that there are nodes on the domain of the settings, or else none on others."""
    own = sum(isinstance(each, NodeToken) for each in facts.seen.tokens)
    others = [
        f"domain {number} has {count(nodes, 'node') if nodes is not None else 'somebody'}"
        for number, nodes in sorted(facts.other_domains.items())
        if nodes != 0
    ]
    here = f"domain {facts.settings.domain} has {count(own, 'node')}"
    if others and not own and not facts.seen.error:
        return Verdict("", (), (f"{here}, but {listed(others)}: is ROS_DOMAIN_ID what you want?",))
    if facts.seen.error:
        return Verdict(listed(others) or "not known", unknown=True)
    return Verdict("; ".join([here, *others]))


def memory(facts: Facts) -> Verdict:
    """Check whether shared memory is on, and safe."""
    found = facts.memory
    remedy = f" ({found.remedy})" if found.remedy else ""
    if found.on and not decide(facts.machine).on:
        lost = "large messages may be lost, and other programs killed"
        return Verdict("", (), (f"shared memory is on, {found.reason}: {lost}{remedy}; {VARIABLE}=auto is safe",))
    slower = "" if found.on else "; messages of megabytes take two to three times as long"
    return Verdict(f"shared memory is {'on' if found.on else 'off'}: {found.reason}{slower}{remedy}")


def clocks(facts: Facts) -> Verdict:
    """Check that the clocks of the other processes agree with this one's."""
    found = facts.seen.clocks
    if not found:
        return Verdict("not measured: no node that tells the time", unknown=True)
    # An answer that took long proves little: only what is beyond its uncertainty counts.
    beyond = {each: abs(each.seconds) - each.uncertainty for each in found}
    worst = max(abs(each.seconds) for each in found) * 1000
    known = max(each.uncertainty for each in found) * 1000
    return Verdict(
        f"{count(len(found), 'node')} asked, {worst:.1f} ms apart at most (measured to within {known:.1f} ms)",
        tuple(_apart(each) for each in found if beyond[each] > WRONG),
        tuple(_apart(each) for each in found if LATE < beyond[each] <= WRONG),
    )


def _apart(offset: ClockOffset) -> str:
    side = "ahead" if offset.seconds > 0 else "behind"
    return (
        f"the clock of {offset.node} is {abs(offset.seconds):.3g} s {side}: "
        "synchronise the machines (chrony, ntp), or it runs on simulated time"
    )


CHECKS = (
    Check("versions", "platform", versions),
    Check("opencv", "platform", opencv),
    Check("settings", "network", settings),
    Check("loopback", "network", loopback),
    Check("reach", "network", reach),
    Check("certificates", "network", certificates),
    Check("rendezvous", "network", rendezvous),
    Check("router", "network", router),
    Check("domains", "network", domains),
    Check("shared memory", "platform", memory),
    Check("clocks", "platform", clocks),
)
