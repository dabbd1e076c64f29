"""The graph on both sides of a mirror between two networks in memory, in virtual time."""

from __future__ import annotations

from typing import Any

import pytest

from robolink import Node
from robolink.dds.mirror.crossing import KNOWN_WITHIN
from robolink.dds.mirror.mirror import LINGER
from robolink.interfaces.example_interfaces.srv import AddTwoInts
from robolink.interfaces.std_msgs.msg import Int32, String
from robolink.message import type_hash
from robolink.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from robolink.wire import (
    NO_HASH,
    DataKey,
    EndpointKind,
    EndpointToken,
    format_key,
    format_token,
    gid_of,
    graph_pattern,
    pack_attachment,
    parse_token,
    unpack_attachment,
)
from tests.support.mirrored import Half, Mirrored, crossings, heard, packed, raw_tokens, send


def test_the_graph_has_each_node_with_its_own_name_on_both_sides(pair: tuple[Mirrored, Half, Half]) -> None:
    scene, here, there = pair
    node = here.node("lidar", namespace="/robot")
    qos = QoSProfile(depth=5, reliability=ReliabilityPolicy.BEST_EFFORT, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    node.create_publisher(String, "scan", qos)
    node.create_subscription(String, "command", print, 10)
    node.create_service(AddTwoInts, "add", print)
    node.create_client(AddTwoInts, "subtract")
    looker = there.node("looker")
    scene.run(0.1)
    assert looker.get_node_names_and_namespaces().count(("lidar", "/robot")) == 1
    for of_node, own in (
        (looker.get_publisher_names_and_types_by_node, node.get_publisher_names_and_types_by_node),
        (looker.get_subscriber_names_and_types_by_node, node.get_subscriber_names_and_types_by_node),
        (looker.get_service_names_and_types_by_node, node.get_service_names_and_types_by_node),
        (looker.get_client_names_and_types_by_node, node.get_client_names_and_types_by_node),
    ):
        assert of_node("lidar", "/robot") == own("lidar", "/robot")
    (seen,), (same,) = (each.get_publishers_info_by_topic("/robot/scan") for each in (looker, node))
    assert (seen.qos_profile, seen.topic_type_hash) == (same.qos_profile, same.topic_type_hash)
    assert looker.count_publishers("/robot/scan") == node.count_publishers("/robot/scan") == 1


def test_two_nodes_of_one_name_stay_two(joined: Mirrored) -> None:
    for _ in range(2):
        joined.a.node("twin")
    looker = joined.b.node("looker")
    joined.run(0.1)
    assert looker.get_node_names().count("twin") == 2


def test_what_goes_is_gone_on_the_other_side(pair: tuple[Mirrored, Half, Half]) -> None:
    scene, here, there = pair
    session = there.session()
    before = session.tokens(graph_pattern(0))
    node = here.node("node")
    node.create_publisher(String, "chatter", 10)
    node.create_service(AddTwoInts, "add", print)
    scene.run(0.1)
    assert len(session.tokens(graph_pattern(0))) > len(before) + 2
    node.destroy_node()
    scene.run(LINGER + 0.1)
    assert session.tokens(graph_pattern(0)) == before
    assert scene.mirror is not None
    assert not scene.mirror._places
    assert not any(side._node_ids for side in scene.mirror.sides)


def test_a_session_that_dies_takes_all_of_it_along(joined: Mirrored) -> None:
    other = joined.a.new_context()
    node = Node("doomed", context=other)
    node.create_publisher(Int32, "chatter", 10)
    looker = joined.b.node("looker")
    joined.until(lambda: looker.count_publishers("/chatter") == 1)
    other.transport.close()
    joined.until(lambda: looker.count_publishers("/chatter") == 0 and "doomed" not in looker.get_node_names(), 1.0)
    other.try_shutdown()


def test_an_endpoint_whose_node_is_announced_after_it(joined: Mirrored) -> None:
    session = joined.a.session()
    endpoint, node = raw_tokens(session.session_id)
    session.announce(format_token(endpoint))
    looker = joined.b.node("looker")
    joined.run(0.1)
    session.announce(format_token(node))
    joined.run(0.1)
    assert looker.get_publisher_names_and_types_by_node("raw", "/") == [("/chatter", ["std_msgs/msg/Int32"])]
    mirrored = [parse_token(each) for each in joined.b.session().tokens(graph_pattern(0))]
    ids = {(each.session, each.node_id) for each in mirrored if each.node_name == "raw"}
    assert len(ids) == 1


def test_data_that_comes_before_the_announcement_waits_for_it(joined: Mirrored) -> None:
    got = heard(joined.b.node("listener"))
    joined.run(0.1)
    session = joined.a.session()
    token = raw_tokens(session.session_id)[0]
    text = format_token(token)
    key = format_key(DataKey(0, token.name, token.type_name, token.type_hash))
    outlet = session.advertise(key, token.qos)
    outlet.put(packed(1), pack_attachment(1, 0, gid_of(text)))
    outlet.put(packed(66), pack_attachment(1, 0, bytes(16)))  # who never says who they are, are not carried
    outlet.put(packed(67), b"")
    joined.run(0.5)
    assert got == []
    session.announce(text)
    joined.until(lambda: got)
    outlet.put(packed(2), pack_attachment(2, 0, gid_of(text)))
    joined.run(KNOWN_WITHIN + 0.5)
    assert got == [1, 2]
    assert joined.mirror is not None
    assert all(not each._parked and not each._bytes_parked for each in crossings(joined))


@pytest.mark.parametrize(
    "text",
    [
        "@ros2_lv/0/nonsense",
        "@ros2_lv/0/1/2/3/XX/%/%/n",
        "@ros2_lv/0/1/2/2/NN/%/%/bad name",
        "@ros2_lv/0/" + "x/" * 3000,
    ],
)
def test_a_token_that_cannot_be_read_harms_nobody(joined: Mirrored, text: str) -> None:
    session = joined.a.session()
    session.announce(text)
    got = heard(joined.b.node("listener"))
    publisher = joined.a.node("talker").create_publisher(Int32, "chatter", 10)
    joined.until(lambda: publisher.get_subscription_count() == 1)
    send(publisher, 1)
    joined.until(lambda: got == [1])
    assert text not in joined.b.session().tokens("**")


def test_a_type_that_robolink_does_not_know(joined: Mirrored) -> None:
    session, far = joined.a.session(), joined.b.session()
    token = raw_tokens(session.session_id)[0]._replace(
        type_name="acme_msgs/msg/Gadget", type_hash="RIHS01_" + "ab" * 32
    )
    other = token._replace(kind=EndpointKind.SUBSCRIPTION, session=far.session_id, node_name="listener")
    got: list[Any] = []
    key = format_key(DataKey(0, token.name, token.type_name, token.type_hash))
    far.subscribe(key, other.qos, got.append)
    far.announce(format_token(other))
    text = format_token(token)
    outlet = session.advertise(key, token.qos)
    session.announce(text)
    joined.until(lambda: outlet.matched)
    outlet.put(b"anything", pack_attachment(5, 9, gid_of(text)))
    joined.until(lambda: got)
    payload, attachment = far.read(got[0])
    assert payload == b"anything"
    assert unpack_attachment(attachment)[:2] == (5, 9)


def test_a_hash_that_one_side_does_not_know_is_that_of_the_other_end(joined: Mirrored) -> None:
    """DDS does not tell a service's hash, and Humble none at all."""
    session = joined.a.session()
    token = raw_tokens(session.session_id, NO_HASH)[0]
    service = token._replace(
        kind=EndpointKind.SERVICE, endpoint_id="3", name="/add", type_name="example_interfaces/srv/AddTwoInts"
    )
    for each in (token, service):
        session.announce(format_token(each))
    joined.run(0.1)
    assert _hashes(joined.b, "raw") == {NO_HASH}
    node = joined.b.node("asker")
    got = heard(node)
    node.create_client(AddTwoInts, "add")
    joined.run(0.1)
    assert _hashes(joined.b, "raw") == {type_hash(Int32), type_hash(AddTwoInts)}
    key = format_key(DataKey(0, token.name, token.type_name, NO_HASH))
    outlet = session.advertise(key, token.qos)
    joined.until(lambda: outlet.matched)
    outlet.put(packed(4), pack_attachment(1, 0, gid_of(format_token(token))))
    joined.until(lambda: got == [4])
    joined.run(0.1)
    assert got == [4]


def _hashes(half: Half, node_name: str) -> set[str]:
    found = [parse_token(each) for each in half.session().tokens(graph_pattern(0))]
    return {each.type_hash for each in found if isinstance(each, EndpointToken) and each.node_name == node_name}


def test_other_types_of_one_topic_do_not_meet(joined: Mirrored) -> None:
    numbers, texts = heard(joined.b.node("n")), heard(joined.b.node("t"), kind=String)
    publisher = joined.a.node("talker").create_publisher(String, "chatter", 10)
    joined.until(lambda: publisher.get_subscription_count() == 1)
    publisher.publish(String(data="x"))
    joined.run(0.3)
    assert (numbers, texts) == ([], ["x"])
