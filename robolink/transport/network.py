"""Zenoh configuration of a session: the requested network's settings or a file's, and what overrides them."""

from __future__ import annotations

import re
import time
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

from robolink.exceptions import TransportError
from robolink.networks.request import (
    ENDPOINT,
    NAMES,
    OVERRIDE,
    NetworkRequest,
    network_of_overrides,
    overrides,
    requested,
)
from robolink.networks.settings import as_ros, client, settings
from robolink.system import clocks
from robolink.system.terminal import shown
from robolink.transport import shared_memory
from robolink.transport.reach import as_json, mode_of

if TYPE_CHECKING:
    from pathlib import Path

    import zenoh

    from robolink.networks.limits import Limits
    from robolink.networks.places import Place

SHARES_MEMORY = "transport/shared_memory/enabled"
"""Path of the setting that offers shared memory to others and accepts it."""

HOST_WITHIN = 1.0
"""Longest wait for the link to a host that was asked for by name, in seconds; it takes some round trips."""

_SHARED_MEMORY = {
    "enabled": True,
    "transport_optimization": {
        "message_size_threshold": shared_memory.SMALLEST_SHARED,
        "messages": shared_memory.MESSAGES,
    },
}


class Plan(NamedTuple):
    """A requested network once it is known what is there: a host, for instance, has answered as a robot or a router.

    Made by `plan`. `config` returns the configuration of a session, which may be asked for again and again.
    """

    request: NetworkRequest
    domain: int
    environ: Mapping[str, str]
    place: Place | None = None
    """The host, or the name of the file of networks, once it is known what it is; None for the other networks."""
    limits: Limits | None = None
    """Limits of slow links, if any are asked for."""
    secure: Callable[[zenoh.Config], object] | None = None
    """Function that closes a configuration to whoever has no keys; None where nobody has any."""

    @property
    def meets(self) -> bool:
        """True if the processes of this machine find each other at the rendezvous port of their domain."""
        if self.place is not None:
            return self.place.meets
        return meets_at_port(self.request.value, self.environ)

    def config(self, *, holds_port: bool = True) -> zenoh.Config:
        """Return Zenoh's configuration; without `holds_port` the session leaves the rendezvous port to another."""
        given = overrides(self.environ)
        config = _overridden(self._limited(self._without_overrides(given, holds_port)), given)
        shares = shared_memory.decision(self.environ, mode=mode_of(config))
        named = any(SHARES_MEMORY.startswith(path) for path, _ in given)
        if not named and (shares.forced or not shares.on):  # else as it is: a file may have it off
            config.insert_json5(SHARES_MEMORY, as_json(shares.on))
        if self.secure is not None:  # the very last: no override opens what it closes
            self.secure(config)
        return config

    def thinned(self) -> list[str] | None:
        """Return the key expressions of the topics that limits thin; None if nothing may be sent again after a cut."""
        if self.secure is not None:  # whoever asked would get topics that its own rights do not name
            return None
        if self.limits is None:
            return []
        from robolink.networks import limits  # late: few sessions need it

        return limits.thinned(self.limits, self.domain)

    def _limited(self, config: zenoh.Config) -> zenoh.Config:
        """Add what thins topics on slow links, if that is asked for."""
        if self.limits is not None:
            from robolink.networks import limits  # late: few sessions need it

            limits.apply(config, self.limits, self.domain)
        return config

    def _without_overrides(self, given: list[tuple[str, str]], holds_port: bool) -> zenoh.Config:
        origin, value = self.request
        # With the loopback's access control a session whose override names a network joins nothing, in silence.
        if origin == OVERRIDE:
            return _config(as_ros(dict(given).get("mode", "")))
        if self.place is not None:
            return _config(self.place.settings(self.domain, holds_port=holds_port))
        if ENDPOINT.fullmatch(value):
            return _config(client(value))
        if value not in NAMES:
            return _from_file(origin, file_of(value))
        found_settings = settings(value, self.domain, holds_port=holds_port)
        if any(path.startswith("access_control") for path, _ in given):  # theirs, and not a mixture with ours
            found_settings.pop("access_control", None)
        return _config(found_settings)


def plan(
    network: str | None, domain: int, environ: Mapping[str, str], secure: Callable[[zenoh.Config], object] | None = None
) -> Plan:
    """Return the requested network, ready to be joined. A host is asked what it is, which takes it some milliseconds.

    Args:
        network: As in `robolink.networks.request.requested`; None asks the environment.
        domain: ROS domain id.
        environ: Variables that may ask for a network, and override settings.
        secure: Function that closes a configuration to whoever has no keys; None does as the environment asks.

    Raises:
        TransportError: if there is no such network, file or host, or if nobody answers there.
    """
    request, secure = requested(network, environ), secure or _secure(domain, environ)
    found = _planned(request, domain, environ, secured=secure is not None)
    return found._replace(limits=limits_for(request, environ), secure=secure)


def _planned(request: NetworkRequest, domain: int, environ: Mapping[str, str], *, secured: bool) -> Plan:
    if _needs_no_name(request):
        return Plan(request, domain, environ)
    from robolink.networks import places  # late: this machine's own network does without

    found = places.find(request, domain, environ, secured=secured)
    if isinstance(found, str):  # what a file of networks says in the place of this name
        return Plan(NetworkRequest(request.origin, found), domain, environ)
    return Plan(request, domain, environ, found)


def _needs_no_name(request: NetworkRequest) -> bool:
    """True for networks that are neither a host nor a name of the file of networks."""
    if request.origin == OVERRIDE or request.value in NAMES or ENDPOINT.fullmatch(request.value):
        return True
    from robolink.system.files import is_file  # late: usually it is a name of this table

    return is_file(file_of(request.value))


def limits_for(request: NetworkRequest, environ: Mapping[str, str]) -> Limits | None:
    """Return the limits of ROBOLINK_LIMITS, else those that the file of networks has for a network; None for none.

    Args:
        request: The network.
        environ: Variables that may have limits, and say where the file of networks is.

    Raises:
        TransportError: for a mistake in either, with its place.
    """
    if environ.get("ROBOLINK_LIMITS"):
        from robolink.networks import limits  # late: few sessions need it

        return limits.requested(environ)
    if _needs_no_name(request):
        return None
    from robolink.networks import networks_file  # late, too

    return networks_file.limits_of(request, environ)


def await_host(session: zenoh.Session, found: Plan) -> None:
    """Wait until the host that has answered is linked, so that the first listing has its nodes; at most HOST_WITHIN."""
    sought = found.place.session if found.place else ""
    deadline = clocks.monotonic() + HOST_WITHIN
    while sought and clocks.monotonic() < deadline:
        if any(str(each) == sought for each in session.info.peers_zid()):
            return
        time.sleep(0.002)


def _secure(domain: int, environ: Mapping[str, str]) -> Callable[[zenoh.Config], object] | None:
    if environ.get("ROS_SECURITY_ENABLE", "false") in ("", "false"):
        return None
    from robolink.transport import secure_config  # late: few sessions need it

    return secure_config.secure_as(domain, environ)


def load(network: str | None, domain: int, environ: Mapping[str, str], *, holds_port: bool = True) -> zenoh.Config:
    """Return Zenoh's configuration of the requested network; raises TransportError that names the option or variable.

    ZENOH_CONFIG_OVERRIDE, `path=json5;path=json5`, has the last word, but for security (ROS_SECURITY_*). If it does
    not name shared memory, that is off where it is not safe, and where ROBOLINK_SHARED_MEMORY says so.
    """
    return plan(network, domain, environ).config(holds_port=holds_port)


def _config(found_settings: dict[str, Any]) -> zenoh.Config:
    import zenoh

    transport = found_settings["transport"] | {"shared_memory": _SHARED_MEMORY}
    config: zenoh.Config = zenoh.Config.from_json5(as_json(found_settings | {"transport": transport}))
    return config


def meets_at_port(value: str, environ: Mapping[str, str]) -> bool:
    """True if the sessions of this network find each other at the rendezvous port of their domain."""
    return value in ("localhost", "lan", "subnet") and not network_of_overrides(environ)


def _from_file(origin: str, path: Path) -> zenoh.Config:
    import zenoh

    try:
        config: zenoh.Config = zenoh.Config.from_file(path)
    except zenoh.ZError as error:
        raise TransportError(f"{origin}: {path}: {reason(error)}") from None
    config.insert_json5("timestamping/enabled", "true")  # latched topics cannot do without
    return config


def file_of(value: str) -> Path:
    """Return the file that a path or a `file://` URL names.

    >>> file_of("file:///C:/robot.json5").as_posix()
    'C:/robot.json5'
    """
    from robolink.system.files import expanded

    return expanded(re.sub(r"^file://(/(?=[A-Za-z]:))?", "", value))


def _overridden(config: zenoh.Config, given: list[tuple[str, str]]) -> zenoh.Config:
    import zenoh

    for path, value in given:
        try:
            config.insert_json5(path, value)
        except (zenoh.ZError, UnicodeEncodeError) as error:  # the latter: bytes that are not UTF-8
            override = shown(f"{path}={value}")
            raise TransportError(f"{OVERRIDE}: '{override}': {reason(error)}") from None
    return config


def reason(error: Exception) -> str:
    """Return the text of a Zenoh error in one line, without places in Zenoh's own source.

    >>> reason(Exception("Timeout! at /home/a/zenoh/src/b.rs:388."))
    'Timeout!'
    """
    text = str(error)
    quoted = re.search(r'(?:msg: |Str\()"((?:[^"\\]|\\.)*)"', text)
    text = quoted[1].replace("\\n", "\n") if quoted else text
    if unmet := re.match(r"Unable to connect to any of \[(?:\w+\()?(.*?)\)?\]\. Timeout!", text):
        return f"nobody lets this session in at {unmet[1]}: is it on, is the port right, and no firewall between?"
    syntax = re.search(r"--> (\d+):(\d+)\n.*= (expected [^\n]*)", text, re.DOTALL)
    text = f"line {syntax[1]}, column {syntax[2]}: {syntax[3]}" if syntax else text
    return " ".join(re.sub(r" at [^\s]+\.rs:\d+\.?", "", text).split())
