"""Attempts across machines: a robot and a student with keys, and attackers without the right ones, over TLS.

    python -m tests.support.attempts [--rounds 5] [--patience 10]

plays it on two machines (network namespaces) that a third one joins, and prints a line for each attacker. What is
asked: what the student may do flows, by `--network HOST`; nothing of an attacker arrives, and no attacker hears any.
"""

from __future__ import annotations

import argparse
import contextlib
import itertools
import json
import os
import queue
import socket
import ssl
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack
from pathlib import Path
from typing import Any, NamedTuple

import zenoh

from robolink.networks.port_probe import listening
from robolink.networks.request import FIRST_PORT
from robolink.qos import QoSProfile
from robolink.security.keystore import Keystore
from robolink.security.policy import Rule
from robolink.transport import connect
from robolink.wire import DataKey, format_key
from tests.support import obedient, stalls
from tests.support.domains import free_domain

ROBOT = "10.78.0.1"
LONG = 60.0
"""Seconds in which a busy machine has done anything."""
POSE, SCAN, DRIVE = "/student/pose", "/scan", "/cmd_vel"
ATTACK, CONTROL = b"attack", b"control"
QOS = QoSProfile(depth=10)

REFUSED = ("no certificate", "foreign authority", "expired", "plain TCP", "TLS 1.2", "false robot")
"""Attackers that get no session, ..."""
DEAF = ("withdrawn",)
"""... and those that get one over which nothing comes or goes."""


class Found(NamedTuple):
    """Outcome of one attacker."""

    opened: bool
    heard: int
    """Messages and tokens that it has got."""


class Outcome(NamedTuple):
    """Outcome of one round."""

    attackers: dict[str, Found]
    arrived: list[str]
    """Keys on which something of an attacker reached the robot."""
    control: Found
    """A bare session with the student's key, which does what the attackers do."""
    controlled: list[str]
    """Keys on which something of it reached the robot."""


def key(name: str, domain: int) -> str:
    """Return the key of a topic of texts."""
    return format_key(DataKey(domain, name, "std_msgs/msg/String", "RIHS01_" + "0" * 64))


def make_stores(folder: Path, domain: int) -> None:
    """Make the keystore of the class, and that of a foreign authority with the same names."""
    for name in ("keys", "foreign"):
        store = Keystore(folder / name, domain)
        store.create()
        for enclave in ("/robot", "/student", "/withdrawn", "/expired"):
            store.create_enclave(enclave, days=-1 if enclave == "/expired" else 30)
        store.permit("/student", [Rule("publish", True, "/student/*"), Rule("subscribe", True, SCAN)])
        store.withdraw("/withdrawn")


# The roles: each obeys its standard input, line by line


def robot(domain: int) -> None:
    """Publish scans, note all that arrives, and answer what has come."""
    session = connect("zenoh://", domain, enclave="/robot")
    arrived: queue.SimpleQueue[tuple[str, bytes]] = queue.SimpleQueue()

    def note(sample: Any) -> None:
        arrived.put((str(sample.key_expr), bytes(sample.payload)))

    bare: zenoh.Session = vars(session)["plain"].session
    listen = zenoh.handlers.Callback(note, indirect=False)
    # Of a subscription to ** nobody is told who may not publish all that; so there are narrower ones beside it.
    asked = ("**", *(key(name, domain) for name in (POSE, DRIVE, SCAN)))
    kept = [bare.declare_subscriber(each, listen, allowed_origin=zenoh.Locality.REMOTE) for each in asked]
    scans = session.advertise(key(SCAN, domain), QOS)
    _repeat(lambda: scans.put(b"scan", b""))
    seen: list[tuple[str, bytes]] = []
    _say("ready")
    for line in sys.stdin:  # until a message with this payload has come
        while not any(payload == line.strip().encode() for _, payload in seen):
            seen.append(arrived.get(timeout=LONG))
        _say(json.dumps([[name, payload.decode()] for name, payload in seen]))
    del kept


def student(domain: int) -> None:
    """Hear a scan through `--network HOST`, then publish what is asked, and say how many scans have come."""
    session = connect("zenoh://", domain, enclave="/student")
    scans: queue.SimpleQueue[Any] = queue.SimpleQueue()
    session.subscribe(key(SCAN, domain), QOS, scans.put)
    pose, marks = session.advertise(key(POSE, domain), QOS), [b"ready"]
    scans.get(timeout=LONG)
    _repeat(lambda: pose.put(marks[-1], b""))
    _say("ready")
    for line in sys.stdin:
        for _ in range(5):  # which an attacker would have had too
            scans.get(timeout=LONG)
        marks.append(line.strip().encode())
        _say("marked")


def attack(domain: int, folder: Path, patience: float) -> None:
    """Try everything at once; then, as long as others ask, say what has been heard."""
    port = FIRST_PORT + domain
    tries = Tries(domain, folder, f"{ROBOT}:{port}", patience)
    control = tries.attacker("keys", "student", CONTROL, LONG)
    for _ in range(int(LONG / 0.01)):  # so that the others have ears as good
        if control.heard:
            break
        time.sleep(0.01)
    names: dict[str, Callable[[], Attacker]] = {
        "no certificate": lambda: tries.attacker("keys", "", ATTACK),
        "foreign authority": lambda: tries.attacker("foreign", "robot", ATTACK),
        "expired": lambda: tries.attacker("keys", "expired", ATTACK),
        "withdrawn": lambda: tries.attacker("keys", "withdrawn", ATTACK, LONG),
        "plain TCP": lambda: tries.plain(port),
        "TLS 1.2": lambda: tries.handshake(port, ssl.TLSVersion.TLSv1_2),
        "TLS 1.3": lambda: tries.handshake(port, ssl.TLSVersion.TLSv1_3),
        "false robot": tries.false_robot,
    }
    with ThreadPoolExecutor(len(names)) as pool:
        made = {name: pool.submit(try_) for name, try_ in names.items()}
        found = {name: each.result() for name, each in made.items()}
    _say("ready")
    for _ in sys.stdin:
        said = {name: each.found() for name, each in found.items()}
        _say(json.dumps({**said, "control": control.found()}))


class Attacker:
    """A session that says and hears all it can; without one, it was not let in."""

    def __init__(self, session: zenoh.Session | None, domain: int, payload: bytes) -> None:
        self.session, self.opened, self.heard = session, session is not None, 0
        if session is None:
            return
        listen, there = zenoh.handlers.Callback(self._hear, indirect=False), zenoh.Locality.REMOTE
        topics = ("**", key(SCAN, domain), key(DRIVE, domain))
        self._kept: list[Any] = [
            *(session.declare_subscriber(each, listen, allowed_origin=there) for each in topics),
            session.liveliness().declare_subscriber("@ros2_lv/**", listen, history=True),
        ]

        def put() -> None:
            for name in (DRIVE, SCAN, POSE):  # in this order: once the last has come, the others had been sent
                session.put(key(name, domain), payload)

        put()
        _repeat(put)

    def _hear(self, _sample: Any) -> None:
        self.heard += 1

    def found(self) -> Found:
        """Return its outcome."""
        return Found(self.opened, self.heard)


class Tries:
    """Attempts of attackers.

    Args:
        domain: Domain of the robot.
        folder: Folder of the keystores.
        place: Address and port of the robot.
        patience: Seconds for which an attacker tries to get a session.
    """

    def __init__(self, domain: int, folder: Path, place: str, patience: float) -> None:
        self._domain, self._folder, self._place, self._patience = domain, folder, place, patience

    def attacker(self, store: str, enclave: str, payload: bytes, patience: float = 0.0) -> Attacker:
        """Return an attacker with the key of an enclave; with none, if that is ''."""
        own = self._files(store, enclave) if enclave else {}
        trusted = str(self._folder / "keys" / "public" / "ca.cert.pem")
        tls = {"root_ca_certificate": trusted, "verify_name_on_connect": False, "enable_mtls": bool(own), **own}
        return Attacker(self._open(f"tls/{self._place}", tls, patience or self._patience), self._domain, payload)

    def plain(self, port: int) -> Attacker:
        """Return an attacker that speaks Zenoh without TLS."""
        answers = listening([port], LONG, ROBOT)
        speaks = [each for each in answers.values() if each.speaks_zenoh]
        attacker = Attacker(self._open(f"tcp/{self._place}", {}, self._patience), self._domain, ATTACK)
        attacker.opened |= bool(speaks)
        return attacker

    def handshake(self, port: int, version: ssl.TLSVersion) -> Attacker:
        """Return whether a handshake succeeds with the student's own key and this version of TLS."""
        files = self._files("keys", "student")
        context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
        context.check_hostname = False
        context.minimum_version = context.maximum_version = version
        context.load_verify_locations(str(self._folder / "keys" / "public" / "ca.cert.pem"))
        context.load_cert_chain(files["connect_certificate"], files["connect_private_key"])
        attacker = Attacker(None, self._domain, ATTACK)
        with contextlib.suppress(ssl.SSLError, OSError):
            plain = socket.create_connection((ROBOT, port), LONG)
            with contextlib.closing(plain), context.wrap_socket(plain):
                attacker.opened = True
        return attacker

    def false_robot(self) -> Attacker:
        """Return whether a student's session takes one of a foreign authority for the robot."""
        with socket.socket() as probe:
            probe.bind(("127.0.0.1", 0))
            place = f"tls/127.0.0.1:{probe.getsockname()[1]}"
        own = self._files("foreign", "robot")
        listens = {f"listen_{name}": own[f"connect_{name}"] for name in ("certificate", "private_key")}
        config = _config("peer", [], listens)
        config.insert_json5("listen/endpoints", json.dumps([place]))
        with zenoh.open(config):
            trusted = str(self._folder / "keys" / "public" / "ca.cert.pem")
            tls = {"root_ca_certificate": trusted, "verify_name_on_connect": False, "enable_mtls": True}
            session = self._open(place, {**tls, **self._files("keys", "student")}, self._patience)
        return Attacker(session, self._domain, ATTACK)

    def _files(self, store: str, enclave: str) -> dict[str, str]:
        folder = self._folder / store / "enclaves" / enclave
        return {"connect_certificate": str(folder / "cert.pem"), "connect_private_key": str(folder / "key.pem")}

    def _open(self, endpoint: str, tls: dict[str, Any], patience: float) -> zenoh.Session | None:
        config = _config("client", [endpoint], tls)
        config.insert_json5("connect/timeout_ms", str(int(patience * 1000)))
        try:
            return zenoh.open(config)
        except zenoh.ZError:
            return None


def _config(mode: str, connects: list[str], tls: dict[str, Any]) -> zenoh.Config:
    wished = {"mode": mode, "connect": {"endpoints": connects}, "scouting": {"multicast": {"enabled": False}}}
    config: zenoh.Config = zenoh.Config.from_json5(json.dumps(wished | {"transport": {"link": {"tls": tls}}}))
    return config


def _repeat(do: Callable[[], object], every: float = 0.05) -> None:
    """Do something again and again on a thread, until the process ends or it fails."""

    def run() -> None:
        pause = threading.Event()
        with contextlib.suppress(Exception):  # the session has been closed
            while not pause.wait(every):
                do()

    threading.Thread(target=run, daemon=True).start()


def _say(text: str) -> None:
    sys.stdout.write(f"{text}\n")
    sys.stdout.flush()


# The scene


def play(patience: float) -> Outcome:
    """Play one round: allowed topics flow while all attackers try."""
    with ExitStack() as stack:
        here, there = stack.enter_context(stalls.two_routed_hosts())
        domain = stack.enter_context(free_domain())
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory()))
        make_stores(folder, domain)

        def start(host: str, role: str, wished: str) -> Any:
            own = {"ENABLE": "true", "STRATEGY": "Enforce", "KEYSTORE": str(folder / "keys")}
            clean = {name: each for name, each in os.environ.items() if not name.startswith(("ROS_", "ZENOH_"))}
            environ = clean | {f"ROS_SECURITY_{name}": each for name, each in own.items()}
            words = [sys.executable, "-m", "tests.support.attempts", role, str(domain), str(folder), str(patience)]
            process = obedient.start(
                stack, ["ip", "netns", "exec", host, *words], environ | {"ROBOLINK_NETWORK": wished}
            )
            assert obedient.line(process) == "ready", role
            return process

        robot_ = start(there, "robot", "lan")
        student_ = start(here, "student", ROBOT)
        attackers = start(here, "attack", ROBOT)
        return _judged(robot_, student_, attackers)


def _judged(robot_: Any, student_: Any, attackers: Any) -> Outcome:
    def asked(process: Any, text: str) -> str:
        obedient.tell(process, text)
        return obedient.line(process)

    asked(robot_, CONTROL.decode())
    assert asked(student_, "marker") == "marked"
    arrived = [(name, payload) for name, payload in json.loads(asked(robot_, "marker"))]
    found = {name: Found(*each) for name, each in json.loads(asked(attackers, "report")).items()}
    control = found.pop("control")
    of = {
        payload: sorted({name for name, each in arrived if each == payload.decode()}) for payload in (ATTACK, CONTROL)
    }
    return Outcome(found, of[ATTACK], control, of[CONTROL])


def faults(outcome: Outcome) -> Iterator[str]:
    """Yield what is not as it should be."""
    found = outcome.attackers
    yield from (f"{name}: got a session" for name in REFUSED if found[name].opened)
    yield from (f"{name}: got no session, so that nothing was tried" for name in DEAF if not found[name].opened)
    yield from (f"{name}: heard {each.heard} messages" for name, each in found.items() if each.heard)
    yield from (f"arrived from an attacker: {each}" for each in outcome.arrived)
    if not found["TLS 1.3"].opened or not outcome.control.opened or not outcome.control.heard:
        yield f"the student's own key does not do what it should: {outcome.control}"
    if [each.split("/")[1:3] for each in outcome.controlled] != [["student", "pose"]]:
        yield f"of the student's key arrived: {outcome.controlled}"


def main() -> None:
    """Play a role, or rounds of all of them."""
    if sys.argv[1:2] and sys.argv[1] in ("robot", "student", "attack"):
        role, domain, folder, patience = sys.argv[1:]
        if role == "attack":
            attack(int(domain), Path(folder), float(patience))
        else:
            {"robot": robot, "student": student}[role](int(domain))
        return
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--patience", type=float, default=10.0)
    asked = parser.parse_args()
    wrong = 0
    for number in range(asked.rounds):
        outcome = play(asked.patience)
        for name, each in itertools.chain(outcome.attackers.items(), [("the student", outcome.control)]):
            _say(f"{number + 1}: {name:18} {'session' if each.opened else 'refused':8} heard {each.heard}")
        for fault in faults(outcome):
            wrong += 1
            _say(f"{number + 1}: FAULT {fault}")
    sys.exit(bool(wrong))


if __name__ == "__main__":
    main()
