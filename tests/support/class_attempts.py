"""Attempts in a class: a student with its own key against a robot on another machine, directly and by a router.

    python -m tests.support.class_attempts [direct | router ...]

makes `class --students 3`, has `launch` start the robot in one network namespace, and plays the student in another. It
prints a table: what was attempted, and whether it was refused. Each is made with a bare session of Zenoh, which looks
at no rule, and again with robolink's own, which has to say why not.
"""

from __future__ import annotations

import contextlib
import json
import os
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import ExitStack
from pathlib import Path
from typing import Any, NamedTuple

import zenoh

from robolink.exceptions import RobolinkError
from robolink.networks.request import FIRST_PORT
from robolink.security import authority, classroom, files, session
from robolink.security.keystore import Keystore
from robolink.transport import connect
from tests.support import obedient, stalls
from tests.support.class_roles import (
    ADMIN,
    ALLOWED_CALL,
    ALLOWED_TOPIC,
    CALLED,
    HEARD,
    MARK,
    POSE,
    PUBLISHED,
    QOS,
    SERVED,
    WILD,
    Student,
    key,
    tokens,
)
from tests.support.domains import free_domain

ROBOT = "10.78.0.1"
LONG = 60.0
"""Seconds in which a busy machine has done anything."""
ROUTER_PORT = 7447
IDENTITIES = ("no certificate", "foreign", "expired", "withdrawn", "signed by a student", "another's certificate")


class Row(NamedTuple):
    """Outcome of one attempt."""

    verb: str
    what: str
    refused: bool
    told: str
    """Message of robolink's own session; '' where it cannot be asked this."""


def attack(domain: int, folder: Path, place: str, wished: str, joins: str) -> None:
    """Play the student, and print the rows, with what is allowed as the first ones."""
    own = environment(folder / "lab" / "student1", "/student1", domain)
    student = Student(domain, bare_config(own, domain, place))
    of_robot: dict[str, list[str]] = {}
    marker = tokens(domain)["allowed"]
    deadline = time.monotonic() + LONG
    for _ in range(2):  # the second time all has been tried beside what is allowed
        student.heard.clear()
        (folder / "robot.json").unlink(missing_ok=True) if not of_robot else None
        while key(ALLOWED_TOPIC, domain) not in student.heard or marker not in of_robot.get("tokens", ()):
            assert time.monotonic() < deadline, (student.heard, of_robot)
            student.publish()
            time.sleep(0.05)
            with contextlib.suppress(OSError):
                of_robot = json.loads((folder / "robot.json").read_bytes())
    rows = [*_allowed(student, domain, of_robot), *_refused(student, domain, of_robot, folder / "robot.json")]
    told = Told(own, domain, wished)
    rows = [row._replace(told=told.of(row)) for row in rows]
    rows += [*_identities(domain, folder, place, wished)] if joins else []
    sys.stdout.write(json.dumps(rows) + "\n")
    sys.stdout.flush()
    sys.stdin.read()


def _allowed(student: Student, domain: int, found: Mapping[str, list[str]]) -> Iterator[Row]:
    yield Row("allowed", f"publish {POSE}", f"False{POSE}" not in found["arrived"], "")
    yield Row("allowed", f"subscribe {ALLOWED_TOPIC}", key(ALLOWED_TOPIC, domain) not in student.heard, "")
    yield Row("allowed", f"call {ALLOWED_CALL}", not student.answered(key(ALLOWED_CALL, domain)), "")
    yield Row("allowed", f"token of {MARK}", tokens(domain)["allowed"] not in found["tokens"], "")


def _refused(student: Student, domain: int, found: Mapping[str, list[str]], notes: Path) -> Iterator[Row]:
    there = set(found["arrived"])
    yield from (Row("publish", name, f"False{name}" not in there, "") for name in PUBLISHED)
    yield Row("publish", "in another domain", not any(each.startswith("True") for each in there), "")
    yield from (Row("subscribe", name, key(name, domain) not in student.heard, "") for name in HEARD)
    extra = student.heard - {key(name, domain) for name in (*HEARD, ALLOWED_TOPIC)}
    yield from (Row("subscribe", each.format(domain="D"), not extra, "") for each in WILD)
    answered = {each: student.answered(each.format(domain=domain)) for each in (*WILD, *ADMIN)}
    answered |= {name: student.answered(key(name, domain)) for name in CALLED}
    called = json.loads(notes.read_bytes())["called"]  # also by those to wildcards
    yield from (
        Row("call", each.format(domain="D"), not is_so and each not in called, "") for each, is_so in answered.items()
    )
    yield from (Row("serve", name, name not in student.asked, "") for name in SERVED)
    for what, text in tokens(domain).items():
        if what != "allowed":
            yield Row("token", what, text not in found["tokens"], "")


class Told:
    """Robolink's own session of the student, and what it says to each attempt.

    Args:
        environ: Environment of the student.
        domain: Domain of the robot.
        wished: Network.
    """

    def __init__(self, environ: dict[str, str], domain: int, wished: str) -> None:
        os.environ.update(environ)
        self._domain, self._session = domain, connect("zenoh://", domain, network=wished, enclave="/student1")

    def of(self, row: Row) -> str:
        """Return the error of an attempt; '' where robolink has no way to make it."""
        verbs: dict[str, Callable[[str], object]] = {
            "publish": lambda there: self._session.advertise(there, QOS),
            "subscribe": lambda there: self._session.subscribe(there, QOS, print),
            "call": lambda there: self._session.call(there, b"", b"", print),
            "serve": lambda there: self._session.serve(there, print),
            "token": self._session.announce,
        }
        if row.verb not in verbs or "*" in row.what:
            return ""
        of, name = (self._domain, row.what) if row.what.startswith("/") else (self._domain + 1, POSE)
        try:
            verbs[row.verb](tokens(self._domain)[row.what] if row.verb == "token" else key(name, of))
        except RobolinkError as error:
            return str(error)
        return ""


def _identities(domain: int, folder: Path, place: str, wished: str) -> Iterator[Row]:
    """Try to get in as somebody else; sessions that are let in have to be deaf and dumb."""
    lab, foreign = folder / "lab" / "keys", folder / "foreign" / "keys"
    student = lab / "enclaves" / "student1"
    made = authority.make_certificate("/robot", authority.load(student / "cert.pem", student / "key.pem"))
    files.write(folder / "made.pem", made.certificate + (student / "cert.pem").read_bytes())
    files.write(folder / "made.key", made.key, files.PRIVATE)
    robot = lab / "enclaves" / "robot" / "cert.pem"
    pairs = {
        "no certificate": None,
        "foreign": (foreign / "enclaves/student1/cert.pem", foreign / "enclaves/student1/key.pem"),
        "expired": (lab / "enclaves/expired/cert.pem", lab / "enclaves/expired/key.pem"),
        "withdrawn": (lab / "enclaves/student3/cert.pem", lab / "enclaves/student3/key.pem"),
        "signed by a student": (folder / "made.pem", folder / "made.key"),
        "another's certificate": (robot, student / "key.pem"),
    }
    said = {
        "foreign": environment(folder / "foreign" / "keys", "/student1", domain),
        "expired": environment(lab, "/expired", domain),
        "withdrawn": environment(folder / "lab" / "student1", "/student3", domain)
        | {"ROS_SECURITY_KEYSTORE": str(lab)},
        "no certificate": environment(folder / "lab" / "student1", "/student2", domain),
    }
    own = environment(folder / "lab" / "student1", "/student1", domain)
    for name in IDENTITIES:
        config = bare_config(own, domain, place, pairs[name])
        told = _said(said[name], domain, wished) if name in said else ""
        yield Row("join", name, not _gets_anything(config, domain), told)


def _gets_anything(config: zenoh.Config, domain: int) -> bool:
    config.insert_json5("connect/timeout_ms", "2000")
    try:
        bare: Any = zenoh.open(config)
    except zenoh.ZError:
        return False
    found: set[str] = set()
    bare.declare_subscriber(key(ALLOWED_TOPIC, domain), lambda sample: found.add(str(sample.key_expr)))
    there = list(bare.liveliness().get(f"@ros2_lv/{domain}/**", timeout=2.0))
    time.sleep(1.0)  # in which scans would have come 20 times
    bare.close()
    return bool(found or there)


def _said(environ: dict[str, str], domain: int, wished: str) -> str:
    os.environ.update(environ)
    try:
        connect("zenoh://", domain, network=wished, enclave=environ["ROS_SECURITY_ENCLAVE_OVERRIDE"]).close()
    except RobolinkError as error:
        return str(error)
    return ""


def environment(store: Path, enclave: str, domain: int) -> dict[str, str]:
    """Return the variables of an enclave, as its security.env has them."""
    own = {"ENABLE": "true", "STRATEGY": "Enforce", "KEYSTORE": str(store), "ENCLAVE_OVERRIDE": enclave}
    return {f"ROS_SECURITY_{name}": each for name, each in own.items()} | {"ROS_DOMAIN_ID": str(domain)}


def bare_config(
    environ: Mapping[str, str], domain: int, place: str, pair: tuple[Path, Path] | bool | None = True
) -> zenoh.Config:
    """Return the configuration of a client with the student's key, or another pair, and no rules."""
    own = session.requested(environ, domain)
    assert own is not None
    tls = session.settings(own)["transport/link/tls"]
    if pair is not True:
        used = {"certificate": str(pair[0]), "private_key": str(pair[1])} if isinstance(pair, tuple) else {}
        tls = {name: each for name, each in tls.items() if name.partition("_")[0] not in ("listen", "connect")}
        tls |= {f"connect_{name}": each for name, each in used.items()} | {"enable_mtls": bool(used)}
    wished = {"mode": "client", "connect": {"endpoints": [place], "timeout_ms": int(LONG * 1000)}}
    config: zenoh.Config = zenoh.Config.from_json5(json.dumps(wished | {"transport": {"link": {"tls": tls}}}))
    config.insert_json5("scouting/multicast/enabled", "false")
    return config


# The scene


def play(way: str, *, joins: bool = True) -> list[Row]:
    """Play it once, `direct` or by a `router` on the robot's machine, with wrong keys or without; return the rows."""
    with ExitStack() as stack:
        here, there = stack.enter_context(stalls.two_routed_hosts())
        domain = stack.enter_context(free_domain())
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory()))
        _make(folder, domain)
        port = ROUTER_PORT if way == "router" else FIRST_PORT + domain
        place = f"tls/{ROBOT}:{port}"
        wished = place if way == "router" else ROBOT
        robolink = [sys.executable, "-m", "robolink"]

        def start(host: str, words: list[str], enclave: str, **environ: str) -> Any:
            clean = {name: each for name, each in os.environ.items() if not name.startswith(("ROS_", "ZENOH_"))}
            own = environment(folder / "lab" / enclave.strip("/"), enclave, domain)
            whole = (
                clean | own | {"ATTEMPTS_FILE": str(folder / "robot.json"), "PYTHONPATH": str(obedient.ROOT)} | environ
            )
            return obedient.start(stack, ["ip", "netns", "exec", host, *words], whole)

        if way == "router":
            router = start(there, [*robolink, "router", "--listen", f"tls/{ROBOT}:{port}"], "/router")
            assert obedient.line(router).startswith("robolink router")
        its_network = "lan" if way == "direct" else place
        start(there, [*robolink, "launch", str(folder / "class.yaml")], "/robot", ROBOLINK_NETWORK=its_network)
        words = [sys.executable, "-m", "tests.support.class_attempts", "attack", str(domain), str(folder)]
        student = start(here, [*words, place, wished, "joins" * joins], "/student1")
        return [Row(*each) for each in json.loads(obedient.line(student))]


def _make(folder: Path, domain: int) -> None:
    """Make the class, another one of the same names, and what `launch` starts."""
    for name in ("lab", "foreign"):
        classroom.make(folder / name, 3, classroom.Class(), domain)
    store = Keystore(folder / "lab" / "keys", domain)
    store.create_enclave("/expired", days=-1)
    store.withdraw("/student3")
    classroom.give_turn(folder / "lab", "2", classroom.Class())
    (folder / "robot.py").write_text(
        "from tests.support import class_roles\n\n\nclass Robot(class_roles.Robot):\n    pass\n"
    )
    (folder / "class.yaml").write_text(f"nodes:\n  - {{node: {folder / 'robot.py'}, enclave: /robot}}\n")


def faults(rows: list[Row]) -> Iterator[str]:
    """Yield what is not as it should be: allowed ones that were refused, others that were not, or not told."""
    for row in rows:
        if row.refused == (row.verb == "allowed"):
            yield f"{row.verb} {row.what}: {'refused' if row.refused else 'went through'}"
        silent = row.verb == "allowed" or "*" in row.what or row.what in IDENTITIES[4:]
        if not row.told and not silent:
            yield f"{row.verb} {row.what}: not told"


def main() -> None:
    """Play the student, or both ways, and print their tables."""
    if sys.argv[1:2] == ["attack"]:
        _, _, domain, folder, place, wished, joins = sys.argv
        attack(int(domain), Path(folder), place, wished, joins)
        return
    wrong = 0
    for way in sys.argv[1:] or ["direct", "router"]:
        rows = play(way)
        for row in rows:
            said = f"told: {row.told}" if row.told else ""
            sys.stdout.write(f"{way:7} {row.verb:10} {row.what:34} {'refused' if row.refused else 'flows':8} {said}\n")
        tried = [row for row in rows if row.verb != "allowed"]
        sys.stdout.write(f"{way}: {sum(row.refused for row in tried)} of {len(tried)} refused\n")
        for fault in faults(rows):
            wrong += 1
            sys.stdout.write(f"{way}: FAULT {fault}\n")
    sys.exit(bool(wrong))


if __name__ == "__main__":
    main()
