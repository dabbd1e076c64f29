"""Which actions there are: asked of a node, and put together of five parts."""

from __future__ import annotations

import pytest

from robolink import Context, Node
from robolink.action import (
    ActionClient,
    ActionServer,
    get_action_client_names_and_types_by_node,
    get_action_names_and_types,
    get_action_server_names_and_types_by_node,
)
from robolink.exceptions import NodeNameNonExistentError
from robolink.graph.action_names import actions
from robolink.interfaces.example_interfaces.action import Fibonacci
from robolink.interfaces.std_msgs.msg import Empty

TYPE = ["example_interfaces/action/Fibonacci"]


def test_a_node_is_asked_for_its_actions_and_those_of_others(virtual: Context) -> None:
    server, client = Node("server", context=virtual, namespace="a"), Node("client", context=virtual, namespace="b")
    ActionServer(server, Fibonacci, "sums", print)
    ActionClient(client, Fibonacci, "/a/sums")
    ActionClient(client, Fibonacci, "more")
    assert get_action_names_and_types(server) == [("/a/sums", TYPE), ("/b/more", TYPE)]
    assert get_action_server_names_and_types_by_node(client, "server", "/a") == [("/a/sums", TYPE)]
    assert get_action_server_names_and_types_by_node(server, "client", "/b") == []
    listed = get_action_client_names_and_types_by_node(server, "client", "/b")
    assert listed == [("/a/sums", TYPE), ("/b/more", TYPE)]
    with pytest.raises(NodeNameNonExistentError):
        get_action_client_names_and_types_by_node(server, "nobody", "/")


def test_who_only_listens_to_the_feedback_is_no_client(virtual: Context) -> None:
    node = Node("node", context=virtual)
    node.create_subscription(Fibonacci.Impl.FeedbackMessage, "sums/_action/feedback", print, 10)
    node.create_publisher(Empty, "/_action/status", 10)
    assert get_action_names_and_types(node) == []


def test_parts_of_odd_types_make_odd_actions_not_errors() -> None:
    services = [(f"/a/_action/{part}", ["x/srv/Y"]) for part in ("send_goal", "cancel_goal", "get_result")]
    topics = [("/a/_action/feedback", ["x/msg/Z"]), ("/a/_action/status", [])]
    assert actions(services, topics) == [("/a", [])]
    assert actions(services[1:], topics) == []
    assert actions(services, topics[1:]) == []
