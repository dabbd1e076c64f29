"""Participants that announce nonsense, and send it: a node lives, sees what is good, and is seen."""

from __future__ import annotations

import contextlib
import random
from collections.abc import Iterator
from typing import Any

import pytest

import robolink
from robolink import Context
from robolink.dds import entities
from robolink.dds.entities import NodeEntities, ParticipantEntities
from robolink.dds.transport import DdsTransport
from robolink.exceptions import InvalidTopicNameException
from robolink.executors import SingleThreadedExecutor
from robolink.interfaces.std_msgs.msg import String
from robolink.interfaces.std_srvs.srv import SetBool
from robolink.qos import DurabilityPolicy, QoSProfile
from robolink.rtps import Endpoint, Qos
from tests.support.fake_rtps import EPROSIMA, OURS, FakeNetwork, FakeParticipant, FakeWriter
from tests.support.waits import wait_until

WORDS = [
    "",
    "/",
    "//",
    "a",
    "victim",
    "/victim",
    "chatter",
    "set",
    "..",
    "%",
    "*",
    "$",
    "\0",
    "\n",
    "\x1b[31m",
    "é",
    "x" * 300,
]
WORDS += [
    "std_msgs",
    "std_srvs",
    "msg",
    "srv",
    "dds_",
    "String_",
    "::",
    "Request",
    "Reply",
    "_Request_",
    "_Response_",
    "0/1",
]
PREFIXES = ["rt", "rq", "rr", "ros_discovery_info", "rt/chatter", "rq/setRequest", "rr/setReply", "", "DCPS"]
TYPES = [
    "std_msgs::msg::dds_::String_",
    "std_srvs::srv::dds_::SetBool_Request_",
    "std_srvs::srv::dds_::SetBool_Response_",
]
DATA = [
    b"",
    b"\0",
    b"enclave=/;\0",
    b"enclave=",
    b"enclave=/a\xff/b;",
    b"typehash=RIHS01_" + b"0" * 64 + b";",
    b"typehash=RIHS99_;",
]
DATA += [
    b"robolink_bridge=;",
    b"robolink_bridge=" + b"z" * 400 + b";",
    bytes(range(256)),
    b"typehash=RIHS01_" + b"f" * 64 + b";enclave=/;",
]
GOOD = ["/chatter", "/latched"]


class Hostile:
    """A participant that announces nonsense, by a seed."""

    def __init__(self, network: FakeNetwork, dice: random.Random) -> None:
        self._dice, self.writers = dice, list[FakeWriter]()
        vendor = dice.choice((OURS, EPROSIMA, b"\0\0"))
        self.participant: FakeParticipant = network.open(user_data=dice.choice(DATA), name=self._text(), vendor=vendor)
        for _ in range(dice.randint(0, 6)):
            topic, type_name = dice.choice(PREFIXES) + self._text(), dice.choice([*TYPES, self._text()])
            if dice.random() < 0.3:
                topic, type_name = dice.choice(
                    [("rt/chatter", TYPES[0]), ("rq/setRequest", TYPES[1]), ("rr/setReply", TYPES[2])]
                )
            if dice.random() < 0.6:
                self.writers.append(self.participant.writer(topic, type_name, self._qos(), user_data=dice.choice(DATA)))
            else:
                qos = self._qos()
                self.participant.reader(topic, type_name, qos, lambda payload, info: None, user_data=dice.choice(DATA))
        self._nodes = self.participant.writer(entities.TOPIC, entities.TYPE, Qos(transient_local=True, depth=1))

    def _text(self) -> str:
        return "".join(self._dice.choice(WORDS) for _ in range(self._dice.randint(0, 4)))

    def _qos(self) -> Qos:
        times = (None, 0.0, 1e-9, 1.0, 2e9)
        numbers = (-1, 0, 1, 0x7FFFFFFF)
        dice = self._dice
        return Qos(
            dice.random() < 0.5,
            dice.random() < 0.5,
            dice.choice(numbers),
            dice.choice(times),
            dice.choice(times),
            dice.randint(0, 2),
            dice.choice(times),
        )

    def say(self) -> None:
        """Tell of nodes, and send samples."""
        dice = self._dice
        ids = [*self.participant.mine, *self.participant.known, dice.randbytes(16)]
        nodes = tuple(
            NodeEntities(self._text(), self._text(), tuple(dice.choices(ids, k=3)), tuple(dice.choices(ids, k=3)))
            for _ in range(dice.randint(0, 3))
        )
        guid = dice.choice((self.participant.guid, self.participant.guid, dice.randbytes(16)))
        told = bytearray(entities.encode(ParticipantEntities(guid, nodes)))
        if dice.random() < 0.3:
            told[dice.randrange(len(told))] = dice.randrange(256)
        self._nodes.put(bytes(told))
        for writer in self.writers:
            payload = dice.choice(
                (b"", b"\0\1\0\0", b"\0\1\0\0\xff\xff\xff\xff", dice.randbytes(30), b"\0\1\0\0\1\0\0\0\0")
            )
            related = dice.choice((None, (dice.choice(ids), dice.randint(0, 1 << 40))))
            writer.put(payload, related=related)


class Victim:
    """A node that does all that can be done, and looks at the graph."""

    def __init__(self, network: FakeNetwork) -> None:
        opens: Any = network.open
        self.context = Context(transport=DdsTransport(opens))
        self.context.init([], domain_id=0)
        self.node = robolink.Node("victim", context=self.context)
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.heard: list[str] = []
        self.publisher = self.node.create_publisher(String, "chatter", 10)
        self.latched = self.node.create_publisher(String, "latched", latched)
        self.node.create_subscription(String, "chatter", lambda message: self.heard.append(message.data), 10)
        self.node.create_service(SetBool, "set", lambda request, response: response)
        self.client = self.node.create_client(SetBool, "set")
        self.executor = SingleThreadedExecutor(context=self.context)
        self.executor.add_node(self.node)

    def listen(self) -> list[str]:
        """Return what it has heard, after a moment."""
        self.executor.spin_once(timeout_sec=0.01)
        return self.heard

    def look(self) -> None:
        """Ask for everything that the graph has."""
        node = self.node
        topics = node.get_topic_names_and_types()
        assert set(GOOD) <= {name for name, _ in topics}
        for name, _ in topics:
            with contextlib.suppress(InvalidTopicNameException):  # DDS lets longer ones pass than ROS 2 does
                node.get_publishers_info_by_topic(name), node.get_subscriptions_info_by_topic(name)
        assert "/set" in {name for name, _ in node.get_service_names_and_types()}
        for name, namespace in node.get_node_names_and_namespaces():
            with contextlib.suppress(robolink.exceptions.RobolinkError):  # those of other nodes may be gone
                node.get_publisher_names_and_types_by_node(name, namespace)


@pytest.fixture
def network() -> Iterator[FakeNetwork]:
    with contextlib.closing(FakeNetwork()) as made:
        yield made


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(4))
def test_a_node_among_participants_that_announce_and_send_nonsense(
    network: FakeNetwork, seed: int, capfd: pytest.CaptureFixture[str]
) -> None:
    dice = random.Random(seed)
    victim = Victim(network)
    victim.look()
    before = victim.node.get_topic_names_and_types()
    hostile = []
    for number in range(40):
        hostile.append(Hostile(network, dice))
        hostile[-1].say()
        if number % 8 == 7:
            victim.client.call_async(SetBool.Request())
            victim.look()
            for each in hostile:
                each.say()
            for _ in range(30):
                victim.executor.spin_once(timeout_sec=0)
    for each in hostile:
        each.participant.close()
    wait_until(lambda: victim.node.get_topic_names_and_types() == before)
    # What is good still works, in the process and beyond.
    friend = network.open(user_data=b"enclave=/;\0")
    got: list[bytes] = []
    reader = friend.reader("rt/chatter", TYPES[0], Qos(), lambda payload, info: got.append(payload))
    wait_until(reader.matched)
    victim.heard.clear()
    victim.publisher.publish(String(data="still here"))
    wait_until(lambda: "still here" in victim.listen())
    wait_until(lambda: bool(got))
    victim.context.try_shutdown()
    said = capfd.readouterr().err
    assert "Traceback" not in said
    assert "what comes of a change of the graph failed" not in said


def test_the_words_are_nonsense_and_good_ones(network: FakeNetwork) -> None:
    """Some of it means something to ROS 2: else little of what is tried would be reached."""
    found: list[Endpoint] = []
    network.open(on_endpoint=lambda endpoint, came: found.append(endpoint))
    for seed in range(50):
        Hostile(network, random.Random(seed))
    wait_until(lambda: len(found) > 100)
    assert {"rt/chatter", "rq/setRequest", "rr/setReply"} <= {each.topic for each in found}
