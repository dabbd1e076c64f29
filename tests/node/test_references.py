"""Nodes that nobody refers to: they leave the graph at once, unless a publisher or client of theirs is in use."""

from __future__ import annotations

import gc
from collections.abc import Iterator

import pytest

from robolink import Context, Node
from robolink.interfaces.std_msgs.msg import Int32
from robolink.interfaces.std_srvs.srv import Trigger
from tests.support.transports import Network, until


@pytest.fixture
def context(zenoh_net: Network) -> Iterator[Context]:
    made = Context(transport=zenoh_net.session())
    made.init([])
    with made:
        yield made


@pytest.fixture
def without_collections() -> Iterator[None]:
    gc.disable()
    yield
    gc.enable()


def names(context: Context) -> list[str]:
    return [each.node_name for each in context.graph.nodes()]


@pytest.mark.usefixtures("without_collections")
def test_a_node_that_nobody_refers_to_goes_without_a_collection(context: Context) -> None:
    """Else it would be there for as long as no collection comes, and a program that forgot it would fail at times."""
    Node("arm", context=context)
    until(lambda: names(context) == [])


def test_who_has_a_publisher_has_its_node(context: Context) -> None:
    publisher = Node("arm", context=context).create_publisher(Int32, "topic", 10)
    gc.collect()
    publisher.publish(Int32(data=1))
    assert [each.get_name() for each in context.nodes] == names(context) == ["arm"]
    del publisher
    gc.collect()
    until(lambda: names(context) == [])


def test_who_has_a_client_has_its_node(context: Context) -> None:
    client = Node("arm", context=context).create_client(Trigger, "reset")
    gc.collect()
    assert not client.service_is_ready()
    assert [each.get_name() for each in context.nodes] == names(context) == ["arm"]
    del client
    gc.collect()
    until(lambda: names(context) == [])
