"""The graph beside a peer of bare Zenoh calls: each sees the other's nodes and endpoints come and go."""

from __future__ import annotations

import re
import struct
from pathlib import Path
from typing import Any

import pytest

from robolink.interfaces.example_interfaces.srv import AddTwoInts
from robolink.interfaces.geometry_msgs.msg import Twist
from robolink.interfaces.std_msgs.msg import String
from robolink.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy, qos_profile_sensor_data
from tests.support.interop import Robot, robot, until
from tests.support.ros2_peer import (
    ADD_TWO_INTS,
    LATCHED,
    SENSOR_DATA,
    STRING,
    TWIST,
    Peer,
    Type,
    gid_of,
    packed_string,
)
from tests.system.interop_wire.calls import add, announced, until_heard

pytestmark = pytest.mark.processes

WIRE = Path(__file__).parents[2] / "data" / "wire"


def test_robolink_announces_itself_as_rmw_zenoh_does(port: int, domain: int, peer: Peer) -> None:
    with robot(port, domain, "driver", "/fleet/r2") as node:
        node.create_publisher(Twist, "cmd_vel", qos_profile_sensor_data)
        node.create_publisher(String, "~/map", QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL))
        node.create_subscription(String, "/chatter", print, 7)
        node.create_service(AddTwoInts, "add", lambda _, response: response)
        node.create_client(AddTwoInts, "/sum")
        expected = [
            ("NN", "", "", ""),
            ("MP", "/fleet/r2/cmd_vel", TWIST, "2::,5:,:,:,,"),
            ("MP", "/fleet/r2/driver/map", STRING, ":1:,1:,:,:,,"),
            ("MS", "/chatter", STRING, "::,7:,:,:,,"),
            ("SS", "/fleet/r2/add", ADD_TWO_INTS, "::,10:,:,:,,"),
            ("SC", "/sum", ADD_TWO_INTS, "::,10:,:,:,,"),
        ]
        zid = str(node.context.transport.session_id)
        own = re.compile(
            rf"@ros2_lv/{domain}/{zid}/0/(\d+)/(..)/%/%fleet%r2/driver(?:/(%[^/]+)/([^/]+)/([^/]+)/([^/]+))?"
        )
        announced(peer, "/SC/", "/%sum/")
        until(lambda: peer.got_tokens() == peer.tokens(), lambda: str(peer.got_tokens()))
        found = {}
        for token in peer.tokens():
            match = own.fullmatch(token)
            assert match, token
            number, *rest = match.groups(default="")
            found[int(number)] = tuple(rest)
        for kind, name, type_, qos in expected:
            shown = (*type_,) if isinstance(type_, Type) else ("", "")
            assert (kind, name.replace("/", "%"), *shown, qos) in found.values()
        assert found[0] == ("NN", "", "", "", "")
        assert sorted(found) == list(range(len(found)))  # one counter, and nobody's number is lost


def test_what_every_node_has(port: int, domain: int, peer: Peer) -> None:
    """A node with nothing of its own, by names and types."""
    with robot(port, domain, "plain", "/lab", plain=True):
        description = ("%lab%plain%get_type_description", "type_description_interfaces::srv::dds_::GetTypeDescription_")
        events, log = "rcl_interfaces::msg::dds_::ParameterEvent_", "rcl_interfaces::msg::dds_::Log_"
        announced(peer, "/SS/%/%lab/plain/" + "/".join(description) + "/RIHS01_", "/::,10:,:,:,,")
        announced(peer, f"/MP/%/%lab/plain/%parameter_events/{events}/RIHS01_", "/::,1000:,:,:,,")
        announced(peer, f"/MP/%/%lab/plain/%rosout/{log}/RIHS01_", "/:1:,1000:,:10,0:,,")


def test_robolink_sees_peers(node: Robot, peer: Peer) -> None:
    stranger = peer.node("stranger", "/lab")
    mouth = stranger.publisher("/scan", STRING, SENSOR_DATA)
    ear = stranger.subscription("/chatter", TWIST, LATCHED)
    stranger.service("/add", ADD_TWO_INTS, add)
    stranger.client("/sum", ADD_TWO_INTS)
    until(lambda: node.count_clients("/sum") == 1)
    assert ("stranger", "/lab", "/") in node.get_node_names_and_namespaces_with_enclaves()
    assert ("/scan", ["std_msgs/msg/String"]) in node.get_topic_names_and_types()
    assert ("/add", ["example_interfaces/srv/AddTwoInts"]) in node.get_service_names_and_types()
    (publisher,) = node.get_publishers_info_by_topic("/scan")
    (subscription,) = node.get_subscriptions_info_by_topic("/chatter")
    assert (publisher.node_name, publisher.node_namespace) == ("stranger", "/lab")
    assert (publisher.topic_type, str(publisher.topic_type_hash)) == ("std_msgs/msg/String", STRING.hash)
    assert bytes(publisher.endpoint_gid)[:16] == gid_of(mouth.token)
    assert bytes(subscription.endpoint_gid)[:16] == gid_of(ear.token)
    assert (publisher.qos_profile.reliability, publisher.qos_profile.depth) == (ReliabilityPolicy.BEST_EFFORT, 5)
    assert subscription.qos_profile.durability is DurabilityPolicy.TRANSIENT_LOCAL
    peer.close()
    until(lambda: node.count_publishers("/scan") == 0)
    until(lambda: ("stranger", "/lab") not in node.get_node_names_and_namespaces())


def test_a_real_token_and_a_real_attachment_of_humble(port: int) -> None:
    """Captured from rmw_zenoh_cpp 0.1.8: the token says who sent what the attachment goes with."""
    token = (WIRE / "liveliness-token-real-humble.txt").read_text().strip()
    attachment = bytes.fromhex((WIRE / "attachment-real-humble.hex").read_text().strip())
    peer = Peer(port, 0)
    try:
        with robot(port, 0) as node:
            peer.announce(token)
            until(lambda: node.count_publishers("/chatter") == 1)
            (info,) = node.get_publishers_info_by_topic("/chatter")
            assert (info.node_name, info.node_namespace) == ("_ros2cli_712", "/")
            assert info.topic_type == "std_msgs/msg/String"
            assert info.qos_profile.durability is DurabilityPolicy.TRANSIENT_LOCAL
            assert info.qos_profile.reliability is ReliabilityPolicy.RELIABLE
            assert info.qos_profile.depth == 1
            assert bytes(info.endpoint_gid)[:16] == attachment[17:]
            sequence, timestamp = struct.unpack("<qq", attachment[:16])
            got: list[tuple[str, Any]] = []
            node.create_subscription(String, "chatter", lambda message, info: got.append((message.data, info)), 10)
            mouth = peer.session.declare_publisher("0/chatter/std_msgs::msg::dds_::String_/TypeHashNotSupported")
            until_heard(node, lambda: mouth.put(packed_string("hello"), attachment=attachment), got)
            assert got[0][0] == "hello"
            assert got[0][1]["publication_sequence_number"] == sequence
            assert got[0][1]["source_timestamp"] == timestamp
    finally:
        peer.close()
