"""Renewal of certificates while all runs: what it loses is counted, its end is told, and who has ended comes back."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from robolink.context import Context
from robolink.exceptions import SecurityError, TransportError
from robolink.executors import SingleThreadedExecutor
from robolink.interfaces.std_msgs.msg import UInt32
from robolink.networks.request import FIRST_PORT
from robolink.node import Node
from robolink.qos import HistoryPolicy, QoSProfile, ReliabilityPolicy
from robolink.security.keystore import Keystore
from robolink.transport import Transport, connect, port_sharing, roaming, secured
from robolink.transport.certificates import Validity
from robolink.transport.secured import SecuredTransport
from tests.support.domains import free_domain
from tests.support.waits import wait_until

pytest.importorskip("cryptography", reason="needs the extra `security`")

LONG = 60.0
DAY = 86400.0
ALL = QoSProfile(history=HistoryPolicy.KEEP_ALL, reliability=ReliabilityPolicy.RELIABLE)


@pytest.fixture
def store(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Keystore]:
    with free_domain() as domain:
        store = Keystore(tmp_path / "keys", domain)
        store.create()
        for name in ("/robot", "/laptop", "/tablet"):
            store.create_enclave(name, days=1)
        monkeypatch.setenv("ROS_SECURITY_ENABLE", "true")
        monkeypatch.setenv("ROS_SECURITY_STRATEGY", "Enforce")
        monkeypatch.setenv("ROS_SECURITY_KEYSTORE", str(store.path))
        monkeypatch.setenv("ROS_DOMAIN_ID", str(domain))
        yield store


def linked(context: Context) -> set[str]:
    """Return the ids of the sessions to which a context is linked."""
    transport = context.transport
    assert isinstance(transport, SecuredTransport)
    return {each.session for each in transport.links()}


@pytest.mark.slow
def test_renewed_certificates_are_in_use_and_what_is_lost_is_counted(store: Keystore) -> None:
    contexts = {name: Context() for name in ("/robot", "/laptop")}
    for name, context in contexts.items():
        context.init(args=["--ros-args", "--enclave", name])
    robot, laptop = (Node(name.strip("/"), context=context) for name, context in contexts.items())
    try:
        heard: list[int] = []
        subscription = laptop.create_subscription(UInt32, "count", lambda message: heard.append(message.data), ALL)
        publisher = robot.create_publisher(UInt32, "count", ALL)
        wait_until(lambda: publisher.get_subscription_count() == 1, LONG)
        executor = SingleThreadedExecutor(context=laptop.context)
        executor.add_node(laptop)
        sent, former = 0, linked(contexts["/robot"]) | linked(contexts["/laptop"])
        assert len(former) == 2
        for name in contexts:
            store.create_enclave(name, days=1, renew=True)
        deadline = time.monotonic() + LONG
        while len(now := linked(contexts["/robot"]) | linked(contexts["/laptop"])) != 2 or now & former:
            assert time.monotonic() < deadline, "the renewed certificates are not in use"
            publisher.publish(UInt32(data=sent))
            sent += 1
            executor.spin_once(timeout_sec=0.01)
        deadline = time.monotonic() + LONG
        while len(heard) + subscription.lost < sent and time.monotonic() < deadline:
            executor.spin_once(timeout_sec=0.1)
        assert heard == sorted({*heard})  # each once, in order
        assert len(heard) + subscription.lost == sent
        assert subscription.lost <= 10  # mostly none; once 1 of 2,241
    finally:
        for context in contexts.values():
            context.shutdown()


def opened(store: Keystore, name: str, seconds: float) -> Transport:
    """Open a session whose certificate ends in so many seconds; in more on a machine that is too busy for that."""
    for longer in (1, 3, 9):
        store.create_enclave(name, days=seconds * longer / DAY, renew=True)
        try:
            return connect("zenoh://", store.domain, enclave=name)
        except SecurityError:
            continue
    raise AssertionError("this machine opens no session in time")


@pytest.mark.slow
def test_who_has_ended_gives_way_and_comes_back_when_renewed(
    store: Keystore, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(roaming, "SETTLED_AFTER", 0.5)
    sessions = [opened(store, "/robot", 3.0)]  # which holds the port at which the others meet
    try:
        robot = sessions[0]
        sessions.append(laptop := connect("zenoh://", store.domain, enclave="/laptop"))
        assert isinstance(robot, SecuredTransport)
        assert isinstance(laptop, SecuredTransport)
        wait_until(lambda: {each.certificate for each in laptop.links()} == {"/robot"}, LONG)
        wait_until(lambda: not port_sharing.is_taken(f"tcp/127.0.0.1:{FIRST_PORT + store.domain}"), LONG)
        said = capfd.readouterr().err
        assert "enclave '/robot': " in said
        assert said.count("cert.pem ends at ") == said.count("cert.pem has ended") == 1
        assert "--renew" in said
        sessions.append(connect("zenoh://", store.domain, enclave="/tablet"))
        wait_until(lambda: {each.certificate for each in laptop.links()} == {"/tablet"}, LONG)
        store.create_enclave("/robot", days=1, renew=True)
        wait_until(lambda: {each.certificate for each in robot.links()} == {"/laptop", "/tablet"}, LONG)
    finally:
        for each in sessions:
            each.close()


class Renewed:
    """A session without a network, whose files say what a test wants."""

    enclave = "/robot"
    has_left = False

    def __init__(self, validity: Validity, files: list[object], answers: list[TransportError | None]) -> None:
        self.validity, self._files, self._answers = validity, files, answers
        self.renewed = self.reopened = 0

    def fingerprint(self) -> object:
        """Return the next of the states of the files; the last again and again."""
        return self._files.pop(0) if len(self._files) > 1 else self._files[0]

    def renew(self) -> None:
        self.renewed += 1
        if self._answers and (error := self._answers.pop(0)):
            raise error

    def reopen(self) -> None:
        self.reopened += 1


def valid_for(seconds: float, *, before: float = 100 * DAY) -> Validity:
    return Validity(time.time() - before, time.time() + seconds, "cert.pem")


def watched(session: Renewed, monkeypatch: pytest.MonkeyPatch, until: int) -> None:
    """Watch a session until it has been renewed so often, and nobody looks any more: a look's line may come last."""
    monkeypatch.setattr(secured, "LOOKS_EVERY", 0.01)
    before = {*threading.enumerate()}
    secured.watch(session)
    wait_until(lambda: session.renewed >= until, LONG)
    session.has_left = True
    for thread in {*threading.enumerate()} - before:
        thread.join(LONG)


def test_a_key_and_its_certificate_that_come_one_by_one_are_taken_together(monkeypatch: pytest.MonkeyPatch) -> None:
    session = Renewed(valid_for(100 * DAY), ["old", "key", "key and certificate", "key and certificate"], [])
    watched(session, monkeypatch, 1)
    assert session.renewed == 1


def test_who_meets_nobody_with_new_keys_tries_again_and_says_so_once(
    monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    answers: list[TransportError | None] = [TransportError("nobody there"), TransportError("nobody there"), None]
    watched(Renewed(valid_for(100 * DAY), ["old", "new"], answers), monkeypatch, 3)
    wait_until(lambda: not answers, LONG)
    assert capfd.readouterr().err.count("nobody there") == 1


@pytest.mark.parametrize(
    ("validity", "told"),
    [
        (valid_for(100 * DAY), ""),
        (valid_for(20 * DAY, before=1000 * DAY), "ends at "),
        (valid_for(20 * DAY), ""),  # a tenth of 120 days
        (valid_for(-1), "has ended"),
        (valid_for(20 * DAY, before=1000 * DAY)._replace(file="keys/identity_ca.cert.pem"), "make a new keystore"),
    ],
)
def test_the_end_is_told_once(
    validity: Validity, told: str, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    session = Renewed(validity, ["old", "old", "old", "new"], [])
    watched(session, monkeypatch, 1)
    said = capfd.readouterr().err
    assert said.count(told) == 1 if told else "ends at" not in said
    assert session.reopened == ("ended" in told)
