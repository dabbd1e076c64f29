"""STOP of the view's server: who presses and releases it, what pages are told, and zeros for who does not listen."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import pytest

from robolink.control.stop_lock import PLAIN, QOS, TOPIC, StopLock
from robolink.exceptions import SecurityError
from robolink.interfaces.geometry_msgs.msg import Twist, TwistStamped
from robolink.interfaces.std_msgs.msg import Bool
from robolink.node import Node
from robolink.serialization import serialize_message
from robolink.view.server import Settings, View, stopping
from robolink.view.server.publishing import moves
from robolink.view.server.stopping import DRIVEN, FEW, drives_of
from robolink.view.sources.live import LiveSource
from robolink.wire import EndpointKind, EndpointToken
from tests.support.view_clients import Client, Shown, shown, until
from tests.view.server.test_publishing import Listener, advertise, forward

HEARD_WITHIN = 0.3
"""Longest time from a press to the first zeros, in seconds."""


def press(client: Client, held: bool = True) -> None:
    forget(client)
    client.send("stop", held=held)


def forget(client: Client) -> None:
    """Let what a client is told from now on be news."""
    client.settle()
    client.heard = [each for each in client.heard if each["op"] != "stop"]


def told(client: Client, held: bool, **more: Any) -> dict[str, Any]:
    """Wait until a client is told that it holds, or not."""
    return client.wait_for("stop", held=held, **more)


class Heard:
    """Messages on /e_stop."""

    def __init__(self, node: Node, qos: Any = QOS) -> None:
        self.all: list[bool] = []
        self.subscription = node.create_subscription(Bool, TOPIC, lambda each: self.all.append(each.data), qos)

    @property
    def last(self) -> bool | None:
        return self.all[-1] if self.all else None


@contextmanager
def second_view(system: Shown, **settings: Any) -> Iterator[View]:
    """Another server of the same system."""
    context = system.new_context()
    source = LiveSource(Node("_view2", context=context, start_parameter_services=False))
    try:
        with View(source, Settings(**{"port": 0, **settings})) as view:
            yield view
    finally:
        context.try_shutdown()


@contextmanager
def client_of(view: View, system: Shown) -> Iterator[Client]:
    before, system.view = system.view, view
    try:
        with system.client() as client:
            yield client
    finally:
        system.view = before


def test_stop_is_said_to_all_pages_and_on_the_topic_until_anybody_releases_it() -> None:
    with shown() as system, system.spinning(), system.client() as one, system.client() as other:
        heard = Heard(system.node)
        assert told(one, False)["unheard"] == {}
        forget(other)
        press(one)
        assert told(one, True) == told(other, True)
        until(lambda: heard.last is True)
        late = Heard(system.node)
        until(lambda: late.all[:1] == [True])
        forget(one)
        press(other, False)
        told(one, False)
        told(other, False)
        until(lambda: heard.last is False and late.last is False)
        until(lambda: not system.node.count_publishers(TOPIC))  # nobody says any more that it is released


def test_a_press_is_told_also_where_it_holds_already() -> None:
    with shown() as system, system.client() as page:
        for held in (True, True, False, False):
            press(page, held)
            told(page, held)


def test_a_page_that_goes_changes_nothing_and_one_that_comes_is_told() -> None:
    with shown() as system, system.spinning():
        robot = Listener(system)
        with system.client() as page:
            press(page)
            told(page, True)
        count = len(robot.heard)
        until(lambda: len(robot.heard) > count + 30)  # for longer than the first second, too
        assert not any(map(moves, robot.heard))
        with system.client() as page:
            told(page, True)


def test_zeros_go_to_a_robot_that_does_not_listen_20_times_a_second_while_it_holds() -> None:
    with shown() as system, system.spinning(), system.client() as page:
        robot, stamped = Listener(system), Listener(system, TwistStamped, "/arm/cmd_vel")
        other = Listener(system, Twist, "/velocity")
        told(page, False, unheard={"/arm/cmd_vel": ["/robot"], "/cmd_vel": ["/robot"]})
        press(page)
        assert until(lambda: bool(robot.heard and stamped.heard)) < HEARD_WITHIN
        took = until(lambda: len(robot.heard) >= 41)
        assert 1.5 < took < 4.0
        assert stamped.heard[-1].header.stamp.sec > 1_600_000_000
        press(page, False)
        told(page, False)
        count = len(robot.heard)
        until(lambda: not system.node.count_publishers("/cmd_vel"))
        assert len(robot.heard) <= count + 2
        assert not other.heard
        assert not any(map(moves, robot.heard + stamped.heard))


def test_robots_that_listen_get_zeros_in_the_first_second_only() -> None:
    with shown() as system, system.spinning(), system.client() as page:
        robot, changes = Listener(system), list[bool]()
        lock = StopLock(system.node, changes.append)
        told(page, False, obeyed=["/robot"], unheard={})
        press(page)
        until(lambda: lock.held)
        until(lambda: bool(robot.heard))
        until(lambda: not system.node.count_publishers("/cmd_vel"))
        assert 10 <= len(robot.heard) <= 30
        press(page, False)
        until(lambda: not lock.held)
        assert changes == [True, False]


def test_zeros_reach_every_topic_however_slow_the_machine_is(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(stopping, "AT_ONCE", -1.0)  # there is never time for a second publisher
    with shown() as system, system.spinning(), system.client() as page:
        robots = [Listener(system, Twist, f"/r{number}/cmd_vel") for number in range(FEW + 2)]
        told(page, False, unheard={f"/r{number}/cmd_vel": ["/robot"] for number in range(FEW + 2)})
        press(page)
        until(lambda: all(len(each.heard) > 5 for each in robots))


def test_while_it_holds_no_client_may_drive() -> None:
    with shown() as system, system.spinning(), system.client() as page, system.client("foxglove.sdk.v1") as driver:
        robot = Listener(system)
        advertise(driver)
        driver.publish(1, forward())
        until(lambda: len(robot.heard) == 1)
        press(page)
        told(page, True)
        for _ in range(5):
            driver.publish(1, forward())
        driver.settle()
        messages = [each["message"] for each in driver.heard if each["op"] == "status"]
        assert messages == ["/cmd_vel: not published: STOP holds (/e_stop)"]
        driver.publish(1, serialize_message(Twist()))  # zeros are welcome
        driver.settle()
        press(page, False)
        told(page, False)
        driver.publish(1, forward())
        until(lambda: sum(map(moves, robot.heard)) > 1)  # the newest heard may still be the first
        assert sum(map(moves, robot.heard)) == 2


@pytest.mark.parametrize("subprotocol", ["foxglove.sdk.v1", "foxglove.websocket.v1"])
def test_a_client_of_foxglove_presses_and_releases_it_by_the_topic(subprotocol: str) -> None:
    with shown() as system, system.spinning(), system.client() as page:
        changes = list[bool]()
        StopLock(system.node, changes.append)
        with system.client(subprotocol) as client:
            channel = {"id": 1, "topic": TOPIC, "encoding": "json", "schemaName": "std_msgs/msg/Bool"}
            client.send("advertise", channels=[channel])
            for held in (True, False, True):
                forget(page)
                client.publish(1, b'{"data": %s}' % str(held).lower().encode())
                told(page, held)
                until(lambda held=held: changes[-1:] == [held])  # type: ignore[misc]
        press(page, False)  # the client has gone, and its true with it
        until(lambda: changes == [True, False, True, False])


@pytest.mark.parametrize("qos", [QOS, PLAIN], ids=["latched", "volatile"])
def test_a_node_presses_and_releases_it_and_may_leave(qos: Any) -> None:
    with shown() as system, system.spinning(), system.client() as page:
        publisher = system.node.create_publisher(Bool, TOPIC, qos)
        publisher.publish(Bool(data=True))
        publisher.destroy()
        told(page, True)
        late = Heard(system.node)
        until(lambda: late.last is True)
        publisher = system.node.create_publisher(Bool, TOPIC, qos)
        forget(page)
        publisher.publish(Bool(data=False))
        told(page, False)
        until(lambda: late.last is False)
        until(lambda: system.node.count_publishers(TOPIC) == 1)


def test_a_volatile_listener_that_starts_late_is_told() -> None:
    with shown() as system, system.spinning(), system.client() as page:
        press(page)
        told(page, True)
        late = Heard(system.node, PLAIN)
        until(lambda: late.last is True)


def test_a_server_that_comes_back_learns_that_it_is_held_from_a_robot() -> None:
    with shown() as system, system.spinning():
        lock = StopLock(system.node, lambda _: None)
        with second_view(system) as view, client_of(view, system) as page:
            press(page)
            until(lambda: lock.held)
        with second_view(system, read_only=True) as view, client_of(view, system) as page:
            told(page, True)
        with second_view(system) as view, client_of(view, system) as page:
            told(page, True)
            press(page, False)
            until(lambda: not lock.held)
            told(page, False)


def test_two_servers_whose_presses_and_releases_cross_end_alike() -> None:
    with shown() as system, system.spinning(), second_view(system) as other:
        lock = StopLock(system.node, lambda _: None)
        with system.client() as one, client_of(other, system) as two:
            for turn in range(30):
                press(one, turn % 2 == 0)
                press(two, turn % 3 == 0)
                one.settle()
                two.settle()
            for client, held in ((two, False), (one, True), (two, False)):
                alike(system, other, lock)  # a release within milliseconds of a press may lose: both end held
                press(client, held)
                until(lambda held=held: states(system, other, lock) == {held})  # type: ignore[misc]


def states(system: Shown, other: View, lock: StopLock) -> set[bool]:
    """What two servers and a robot think."""
    assert system.view.hub.stopping is not None
    assert other.hub.stopping is not None
    return {lock.held, system.view.hub.stopping.held, other.hub.stopping.held}


def alike(system: Shown, other: View, lock: StopLock) -> None:
    """Wait until all have thought the same for a second."""
    since = time.monotonic()

    def stayed() -> bool:
        nonlocal since
        if len(states(system, other, lock)) > 1:
            since = time.monotonic()
        return time.monotonic() - since > 1.0

    until(stayed)


@pytest.mark.parametrize("settings", [{"read_only": True}, {}])
def test_who_may_not_change_anything_sees_it_and_cannot_press_or_release_it(settings: dict[str, Any]) -> None:
    with shown(**settings) as system, system.spinning(), system.client(token=bool(settings)) as page:
        heard, robot = Heard(system.node), Listener(system)
        publisher = system.node.create_publisher(Bool, TOPIC, QOS)
        press(page)
        assert "STOP is refused, since this connection is read-only" in page.wait_for("status")["message"]
        assert not heard.all
        publisher.publish(Bool(data=True))
        told(page, True)
        press(page, False)
        assert "release of STOP is refused" in page.wait_for("status")["message"]
        if settings:  # a server on which nobody may change anything says nothing itself
            assert (heard.all, robot.heard) == ([True], [])


def test_a_press_that_may_not_be_said_is_refused_and_sends_zeros(monkeypatch: pytest.MonkeyPatch) -> None:
    with shown() as system, system.spinning(), system.client() as page:
        robot, node = Listener(system), system.source.node
        made = node.create_publisher

        def checked(cls: Any, topic: str, *more: Any, **named: Any) -> Any:
            if topic == TOPIC:
                raise SecurityError("this enclave may not publish /e_stop")
            return made(cls, topic, *more, **named)

        monkeypatch.setattr(node, "create_publisher", checked)
        StopLock(system.node, print)  # obeys, and hears nothing of it
        page.wait_for("stop", obeyed=["/robot"])
        press(page)
        assert "this enclave may not publish /e_stop" in page.wait_for("status")["message"]
        until(lambda: bool(robot.heard))
        assert not moves(robot.heard[0])
        assert system.view.hub.stopping is not None
        assert not system.view.hub.stopping.held
        until(lambda: not system.node.count_publishers("/cmd_vel"))


def test_a_flood_is_followed_to_its_end_without_an_echo_of_each(monkeypatch: pytest.MonkeyPatch) -> None:
    with shown() as system, system.spinning(), system.client() as page:
        publisher = system.node.create_publisher(Bool, TOPIC, 10)
        node, made, echoes = system.source.node, system.source.node.create_publisher, list[str]()

        def counted(cls: Any, topic: str, *more: Any, **named: Any) -> Any:
            echoes.append(topic)
            return made(cls, topic, *more, **named)

        monkeypatch.setattr(node, "create_publisher", counted)
        for number in range(600):
            publisher.publish(Bool(data=number % 2 == 0))
        for held in (True, False):
            forget(page)  # after all that has come
            publisher.publish(Bool(data=held))
            told(page, held)
        assert len(echoes) < 10


@pytest.mark.parametrize("payload", [b"", b"\x00\x01\x00", b"\x00\x01\x00\x00\x07", b"nonsense" * 100])
def test_nonsense_on_the_topic_changes_nothing(payload: bytes) -> None:
    with shown() as system, system.spinning(), system.client() as page:
        publisher = system.node.create_publisher(Bool, TOPIC, QOS)
        publisher.publish(payload)
        page.settle()
        publisher.publish(Bool(data=True))
        told(page, True)
        forget(page)
        publisher.publish(Bool(data=False))
        told(page, False)


# Who obeys


def end(node: str, kind: str, topic: str, type_name: str = "") -> EndpointToken:
    types = {"/e_stop": "std_msgs/msg/Bool"}
    name = type_name or types.get(topic, DRIVEN[0])
    namespace, _, own = node.rpartition("/")
    return EndpointToken(0, "1", "1", "1", EndpointKind[kind], "", namespace or "/", own, topic, name, "h", QOS)


def test_a_base_that_listens_obeys_and_one_that_does_not_is_named() -> None:
    ends = [end("/a", "SUBSCRIPTION", "/a/cmd_vel"), end("/a", "SUBSCRIPTION", TOPIC)]
    ends += [end("/b", "SUBSCRIPTION", "/b/cmd_vel"), end("/teleop", "PUBLISHER", "/b/cmd_vel")]
    found = drives_of(ends)
    assert (found.obeyed, found.unheard, set(found.deaf)) == (["/a"], {"/b/cmd_vel": ["/b"]}, {"/b/cmd_vel"})
    assert set(found.all_of_them) == {"/a/cmd_vel", "/b/cmd_vel"}


def test_a_base_behind_a_mux_that_listens_gets_zeros_and_no_warning() -> None:
    mux = [end("/twist_mux", "SUBSCRIPTION", topic) for topic in ("/nav/cmd_vel", TOPIC)]
    ends = [*mux, end("/twist_mux", "PUBLISHER", "/cmd_vel_out"), end("/base", "SUBSCRIPTION", "/cmd_vel_out")]
    found = drives_of(ends)
    assert (found.obeyed, found.unheard, set(found.deaf)) == (["/twist_mux"], {}, {"/cmd_vel_out"})
    for other in ("/joystick", "/_robolink_pub_7", "/_ros2cli_12"):  # also a command that drives
        found = drives_of([*ends, end(other, "PUBLISHER", "/cmd_vel_out")])
        assert found.unheard == {"/cmd_vel_out": ["/base"]}
    view = [end("/_robolink_cli_8", "PUBLISHER", topic) for topic in (TOPIC, "/cmd_vel_out")]  # it sends zeros
    assert not drives_of([*ends, *view]).unheard


def test_commands_and_other_topics_are_no_robots() -> None:
    ends = [end("/_robolink_echo", "SUBSCRIPTION", "/cmd_vel"), end("/_robolink_view", "SUBSCRIPTION", TOPIC)]
    ends += [end("/a", "SUBSCRIPTION", "/speed"), end("/a", "SUBSCRIPTION", "/cmd_vel", "std_msgs/msg/String")]
    assert drives_of(ends) == drives_of(())
