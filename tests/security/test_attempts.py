"""Attempts of a hostile enclave over TLS: it has a key, and no rules of its own. What it has no right to is dropped.

One robot, with what robolink gives it; one attacker, a bare Zenoh session. Each attempt is followed, on the same link,
by something that is allowed: when that has come, what was attempted before it would have come too.
"""

from __future__ import annotations

import itertools
import json
import queue
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
import zenoh

from robolink.security import session
from robolink.security.keystore import Keystore
from robolink.security.policy import Profile, Rule
from robolink.wire import DataKey, format_key
from tests.support.ports import free_port

pytest.importorskip("cryptography", reason="needs the extra `security`")

LONG = 60.0
"""Seconds in which a busy machine has done anything."""
DOMAIN = 5
ROBOT = [
    Rule("publish", True, "/*"),
    Rule("subscribe", True, "/*"),
    Rule("reply", True, "/*"),
    Rule("request", True, "/*"),
]
STUDENT = [
    *(Rule("subscribe", True, name) for name in ("/scan", "/map", "/robot/*")),
    *(Rule(kind, True, "/student1/*") for kind in ("publish", "subscribe", "reply", "request")),
    Rule("request", True, "/robot/get_parameters"),
    Rule("call", True, "/dance"),
    Rule("subscribe", False, "/robot/secret"),
    Rule("publish", False, "/student1/denied"),
    Rule("request", False, "/student1/denied"),
]


def key(name: str, domain: int = DOMAIN) -> str:
    return format_key(DataKey(domain, name, "std_msgs/msg/String", "RIHS01_" + "0" * 64))


def token(kind: str, name: str, enclave: str = "%student1", domain: int = DOMAIN) -> str:
    end = (
        f"/{name.replace('/', '%')}/std_msgs::msg::dds_::String_/RIHS01_{'0' * 64}/::,10:,:,:,," if kind != "NN" else ""
    )
    return f"@ros2_lv/{domain}/ab/0/1/{kind}/{enclave}/%/node{end}"


class Scene:
    """The robot's session, the attacker's, and everything that reached either."""

    def __init__(self, folder: Path, enclave: str, *, known: bool = True) -> None:
        store = Keystore(folder / "keys", DOMAIN)
        store.create()
        store.create_enclave("/robot")
        store.create_enclave("/student1")
        store.permit_profiles("/robot", [Profile("/", "robot", ROBOT)])
        store.permit_profiles("/student1", [Profile("/student1", "node", STUDENT)])
        environ = {"ROS_SECURITY_ENABLE": "true", "ROS_SECURITY_KEYSTORE": str(store.path)}
        security = session.requested(environ, DOMAIN, "/robot")
        assert security is not None
        self.port = free_port()
        self.robot = zenoh.open(self.config(session.settings(security), listen=True))
        own = session.requested(environ, DOMAIN, enclave)
        assert own is not None
        bare = session.settings(own) | {"access_control": {"enabled": False}}
        self.attacker = zenoh.open(self.config(bare, listen=False))

    def config(self, settings: dict[str, Any], *, listen: bool) -> zenoh.Config:
        config: zenoh.Config = zenoh.Config()
        place = [f"tls/127.0.0.1:{self.port}"]
        config.insert_json5("scouting/multicast/enabled", "false")
        config.insert_json5("listen/endpoints", json.dumps(place if listen else []))
        config.insert_json5("connect/endpoints", json.dumps([] if listen else place))
        config.insert_json5("connect/timeout_ms", "20000")
        for path, value in settings.items():
            config.insert_json5(path, json.dumps(value))
        return config

    def close(self) -> None:
        for each in (self.attacker, self.robot):
            end(each, "close")


@pytest.fixture(scope="module")
def scene(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Scene]:
    made = Scene(tmp_path_factory.mktemp("attempts"), "/student1")
    yield made
    made.close()


def end(what: Any, how: str = "undeclare") -> None:
    """End a session or a declaration; Zenoh's methods have no types."""
    getattr(what, how)()


def is_matched(publisher: Any) -> bool:
    return bool(publisher.matching_status.matching)


def until(condition: Callable[[], bool]) -> None:
    deadline = time.monotonic() + LONG
    while not condition():
        assert time.monotonic() < deadline, "never came"
        time.sleep(0.01)


def in_order(arrived: queue.SimpleQueue[str]) -> Any:
    """Return a handler for several subscribers: Zenoh's usual one has a thread for each, and these know no order."""

    def note(sample: Any) -> None:
        arrived.put(str(sample.key_expr))

    return zenoh.handlers.Callback(note, indirect=False)


_numbers = itertools.count()


def new(start: str) -> str:
    """Return a name that no attempt has used before: of a used one a session may still believe that it is there."""
    return f"{start}{next(_numbers)}"


def came(sender: zenoh.Session, receiver: zenoh.Session, name: str, marker: str, domain: int = DOMAIN) -> bool:
    """Return whether a message of one session reaches the other, by the time that an allowed one has."""
    arrived: queue.SimpleQueue[str] = queue.SimpleQueue()
    declared = [receiver.declare_subscriber(each, in_order(arrived)) for each in (key(name, domain), key(marker))]
    publisher = sender.declare_publisher(key(marker))
    until(lambda: is_matched(publisher))
    sender.put(key(name, domain), b"attempt")
    publisher.put(b"marker")
    found = [arrived.get(timeout=LONG)]
    while found[-1] != key(marker):
        found.append(arrived.get(timeout=LONG))
    for each in (*declared, publisher):
        end(each)
    return key(name, domain) in found


SENT = [
    *("/cmd_vel", "/scan", "/map", "/robot/x", "/tf", "/tf_static", "/clock", "/goal_pose", "/emergency_stop"),
    *("/student2/x", "/student10/x", "/student1", "/student1/denied", "/dance/_action/feedback", "/other"),
]
HEARD = ["/cmd_vel", "/odom", "/student2/x", "/student1", "/robot", "/robot/secret", "/rosout", "/camera/image", "/tf"]
ASKED = [
    *("/robot/set_parameters", "/robot/list_parameters", "/robot/set_parameters_atomically", "/reset", "/student2/ask"),
    *("/student1/denied", "/robot/get_state", "/fly/_action/send_goal", "/dance2/_action/send_goal"),
]
SERVED = ["/reset", "/robot/get_parameters", "/student2/ask", "/dance/_action/send_goal", "/robot/get_state"]
TOKENS = [
    *(
        token("NN", "", "%robot"),
        token("NN", "", "%student2"),
        token("NN", "", domain=DOMAIN + 1),
        token("NN", "", "%"),
    ),
    *(token("MP", "/cmd_vel"), token("MP", "/scan"), token("MS", "/cmd_vel"), token("SS", "/reset")),
    *(token("SC", "/robot/set_parameters"), token("MP", "/student1/x", "%robot")),
]


@pytest.mark.parametrize("name", SENT)
def test_what_it_may_not_publish_does_not_arrive(scene: Scene, name: str) -> None:
    assert not came(scene.attacker, scene.robot, name, new("/student1/marker"))


@pytest.mark.parametrize("name", HEARD)
def test_what_it_may_not_hear_is_not_sent(scene: Scene, name: str) -> None:
    assert not came(scene.robot, scene.attacker, name, new("/robot/marker"))


def test_other_domains_are_closed_both_ways(scene: Scene) -> None:
    assert not came(scene.attacker, scene.robot, "/student1/x", new("/student1/marker"), DOMAIN + 1)
    assert not came(scene.robot, scene.attacker, "/scan", new("/robot/marker"), DOMAIN + 1)


@pytest.mark.parametrize("name", ["/student1/x", "/student1/a/b", "/rosout", "/parameter_events"])
def test_what_it_may_publish_arrives(scene: Scene, name: str) -> None:
    assert came(scene.attacker, scene.robot, name, new("/student1/marker"))


@pytest.mark.parametrize("name", ["/map", "/scan", "/robot/pose", "/dance/_action/status", "/clock"])
def test_what_it_may_hear_arrives(scene: Scene, name: str) -> None:
    assert came(scene.robot, scene.attacker, name, new("/robot/marker"))


def answered(asker: zenoh.Session, server: zenoh.Session, name: str, marker: str) -> bool:
    """Return whether a call is answered; asked when one that is allowed already is."""

    def answer(query: zenoh.Query) -> None:
        query.reply(query.key_expr, b"answer")

    declared = [server.declare_queryable(key(each), answer, complete=True) for each in (name, marker)]

    def call(asked: str) -> bool:
        return bool(list(asker.get(key(asked), target=zenoh.QueryTarget.ALL_COMPLETE, timeout=LONG)))

    until(lambda: call(marker))
    found = call(name)
    for each in declared:
        end(each)
    return found


@pytest.mark.parametrize("name", ASKED)
def test_what_it_may_not_call_is_not_asked(scene: Scene, name: str) -> None:
    assert not answered(scene.attacker, scene.robot, name, new("/student1/ask"))


@pytest.mark.parametrize("name", SERVED)
def test_what_it_may_not_serve_is_not_asked_of_it(scene: Scene, name: str) -> None:
    assert not answered(scene.robot, scene.attacker, name, new("/student1/ask"))


@pytest.mark.parametrize("name", ["/dance/_action/send_goal", "/dance/_action/get_result", "/robot/get_parameters"])
def test_what_it_may_call_is_answered(scene: Scene, name: str) -> None:
    assert answered(scene.attacker, scene.robot, name, new("/student1/ask"))


def seen(scene: Scene, text: str) -> bool:
    """Return whether the robot sees a token of the attacker, by the time that it sees one that is allowed."""
    arrived: queue.SimpleQueue[str] = queue.SimpleQueue()
    marker = token("MP", new("/student1/marker"))
    watch = scene.robot.liveliness().declare_subscriber("@ros2_lv/**", in_order(arrived), history=True)
    declared = [scene.attacker.liveliness().declare_token(each) for each in (text, marker)]
    found = [arrived.get(timeout=LONG)]
    while found[-1] != marker:
        found.append(arrived.get(timeout=LONG))
    for each in (*declared, watch):
        end(each)
    return text in found


@pytest.mark.parametrize("text", TOKENS)
def test_no_token_of_others_or_for_what_it_may_not_do_is_seen(scene: Scene, text: str) -> None:
    assert not seen(scene, text)


@pytest.mark.parametrize("text", [token("NN", ""), token("MP", "/student1/x"), token("SC", "/dance/_action/send_goal")])
def test_its_own_tokens_are_seen(scene: Scene, text: str) -> None:
    assert seen(scene, text)


def test_wild_subscriptions_get_no_more(scene: Scene) -> None:
    arrived: queue.SimpleQueue[str] = queue.SimpleQueue()
    marker = new("/robot/marker")
    wild = [
        scene.attacker.declare_subscriber(each, in_order(arrived))
        for each in ("**", f"{DOMAIN}/**", f"{DOMAIN}/*/*/*/**", key(marker))
    ]
    publisher = scene.robot.declare_publisher(key(marker))
    until(lambda: is_matched(publisher))
    for name in ("/cmd_vel", "/robot/secret", "/odom"):
        scene.robot.put(key(name), b"secret")
    publisher.put(b"marker")
    found = [arrived.get(timeout=LONG)]
    while not arrived.empty():
        found.append(arrived.get())
    assert set(found) == {key(marker)}
    for each in (*wild, publisher):
        end(each)


def test_there_are_at_least_forty_attempts() -> None:
    assert len(SENT) + len(HEARD) + len(ASKED) + len(SERVED) + len(TOKENS) + 3 >= 40
