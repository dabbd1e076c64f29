"""zenoh-ros2-sdk, a ROS 2 peer that others wrote, and robolink's nodes are one system behind a router of ROS 2."""

from __future__ import annotations

import contextlib
import json
import math
import queue
import sys
from array import array
from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import pytest

from robolink.cli.main import main
from robolink.client import Client
from robolink.exceptions import ServiceError
from robolink.interfaces.example_interfaces.srv import AddTwoInts
from robolink.interfaces.geometry_msgs.msg import Twist
from robolink.interfaces.sensor_msgs.msg import Image, LaserScan
from robolink.interfaces.std_msgs.msg import String
from robolink.message import Message, from_builtins, type_hash
from robolink.publisher import Publisher
from robolink.qos import DurabilityPolicy, QoSProfile, qos_profile_sensor_data
from tests.support.domains import free_domain
from tests.support.interop import PATIENCE, Robot, put_router_at, robot, until
from tests.support.ros2_peer import router
from tests.support.sdk_peer import Sdk

pytestmark = pytest.mark.processes


class Lab(NamedTuple):
    """Where everybody meets."""

    port: int
    domain: int


@pytest.fixture(scope="module")
def lab() -> Iterator[Lab]:
    with router() as port, free_domain() as domain:
        yield Lab(port, domain)


@pytest.fixture(scope="module")
def sdk(lab: Lab) -> Iterator[Sdk]:
    with Sdk(*lab) as running:
        yield running


@pytest.fixture
def node(lab: Lab, sdk: Sdk) -> Iterator[Robot]:
    with robot(*lab) as made:
        yield made


SENSOR = "2::,5:,:,:,,"
HEADER = {"stamp": {"sec": 1_700_000_000, "nanosec": 999_999_999}, "frame_id": "laser"}
PIXELS = bytes(range(256)) * 4096
MESSAGES: dict[str, tuple[type[Message], dict[str, Any]]] = {
    "std_msgs/msg/String": (String, {"data": "Grüße, 世界 \U0001f916"}),
    "geometry_msgs/msg/Twist": (
        Twist,
        {"linear": {"x": 0.3, "y": -0.0, "z": 1e300}, "angular": {"x": 5e-324, "y": math.pi, "z": -math.inf}},
    ),
    "sensor_msgs/msg/LaserScan": (
        LaserScan,
        {
            "header": HEADER,
            "angle_min": -1.5,
            "angle_max": 1.5,
            "angle_increment": 0.0078125,
            "time_increment": 0.0,
            "scan_time": 0.125,
            "range_min": 0.0625,
            "range_max": 12.0,
            "ranges": [1.25, math.inf, math.nan, -math.inf, 0.0, *(beam / 64 for beam in range(360))],
            "intensities": [],
        },
    ),
    "sensor_msgs/msg/Image": (
        Image,
        {
            "header": HEADER,
            "height": 512,
            "width": 2048,
            "encoding": "mono8",
            "is_bigendian": 0,
            "step": 2048,
            "data": PIXELS.hex(),
        },
    ),
}


def made(cls: type[Message], values: dict[str, Any]) -> Any:
    """The robolink message of these values."""
    if cls is Image:
        values = {**values, "data": PIXELS}
    return from_builtins(cls, values)


def plain(value: Any) -> Any:
    """A robolink message as the SDK's process shows one: bytes in hex."""
    if isinstance(value, Message):
        return {name: plain(getattr(value, name)) for name in value.__ros_fields__}
    if isinstance(value, array) and value.typecode != "B":
        return value.tolist()
    return value if isinstance(value, (str, int, float)) else bytes(value).hex()


def same(found: Any, expected: dict[str, Any]) -> bool:
    """Whether every field is the same; NaN is, too, and -0.0 is not 0.0."""
    return json.dumps(found) == json.dumps(expected)


def heard(sdk: Sdk, publisher: Publisher[Any], message: Any) -> Any:
    """Publish until the SDK hears it, which announces a subscription before it subscribes; what it heard."""
    answers: list[Any] = []

    def arrived() -> bool:
        publisher.publish(message)
        with contextlib.suppress(queue.Empty):
            answers.append(sdk.message(publisher.topic_name, patience=0.1))
        return bool(answers)

    until(arrived, lambda: str(sdk.errors))
    return answers[0]


def says(sdk: Sdk, expected: Callable[[Any], Any], request: str, **arguments: Any) -> None:
    """Ask until the answer is right: the SDK takes one look, and tokens of the last instants may be missing in it."""
    answers: list[Any] = []

    def right() -> bool:
        answers.append(sdk.ask(request, **arguments))
        return expected(answers[-1]) is True

    until(right, lambda: f"{request}: {answers[-1]}")


@pytest.mark.parametrize("type_name", MESSAGES)
def test_what_the_sdk_publishes(sdk: Sdk, node: Robot, type_name: str) -> None:
    cls, values = MESSAGES[type_name]
    topic = f"/from_sdk/{cls.__name__}"
    got: list[Any] = []
    node.create_subscription(cls, topic, got.append, 10)
    sdk.ask("publisher", topic=topic, type_name=type_name, node="sdk_talker")

    def arrived() -> bool:  # what is sent in the first instants may be lost between the router and a direct link
        sdk.ask("publish", topic=topic, values=values)
        return bool(got)

    node.spin_until(arrived)
    assert all(same(plain(each), values) for each in got)
    until(lambda: node.count_publishers(topic) == 1)


@pytest.mark.parametrize("type_name", MESSAGES)
def test_what_the_sdk_hears(sdk: Sdk, node: Robot, type_name: str) -> None:
    cls, values = MESSAGES[type_name]
    topic = f"/to_sdk/{cls.__name__}"
    publisher = node.create_publisher(cls, topic, 10)
    sdk.ask("subscribe", topic=topic, type_name=type_name, node="sdk_listener")
    assert same(heard(sdk, publisher, made(cls, values)), values)
    publisher.publish(made(cls, values))
    assert same(sdk.message(topic), values)
    until(lambda: publisher.get_subscription_count() == 1)


def test_the_sdk_joins_after_robolink(lab: Lab) -> None:
    with robot(*lab) as node:
        got: list[str] = []
        node.create_subscription(String, "/late/to_robolink", lambda message: got.append(message.data), 10)
        publisher = node.create_publisher(String, "/late/to_sdk", 10)
        with Sdk(*lab) as sdk:
            sdk.ask("publisher", topic="/late/to_robolink", type_name="std_msgs/msg/String", node="late")

            def arrived() -> bool:
                sdk.ask("publish", topic="/late/to_robolink", values={"data": "here I am"})
                return bool(got)

            node.spin_until(arrived)
            assert got[0] == "here I am"
            sdk.ask(
                "subscribe", topic="/late/to_sdk", type_name="std_msgs/msg/String", node="late_too", namespace="/lab"
            )
            assert heard(sdk, publisher, String(data="welcome")) == {"data": "welcome"}
            until(lambda: {"/late", "/lab/late_too"} <= set(node.get_fully_qualified_node_names()))
        until(lambda: not {"/late", "/lab/late_too"} & set(node.get_fully_qualified_node_names()))
        until(lambda: publisher.get_subscription_count() == 0)


def test_what_robolink_keeps_for_late_joiners(sdk: Sdk, node: Robot) -> None:
    """The SDK asks the publisher's cache itself, in a way that gives only the newest."""
    latched = QoSProfile(depth=2, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    publisher = node.create_publisher(String, "/kept", latched)
    for text in ("one", "two", "three"):
        publisher.publish(String(data=text))

    found: list[Any] = []

    def given() -> bool:  # it sees the publisher only after some instants, and does not ask a second time
        sdk.ask("subscribe", topic="/kept", type_name="std_msgs/msg/String", node="sdk_late", qos=":1:,2:,:,:,,")
        with contextlib.suppress(queue.Empty):  # there may be messages of earlier tests, which it passes over
            found.append(sdk.message("/kept", 0.02))
        return bool(found)

    until(given)
    assert found == [{"data": "three"}]


def can_call(client: Client) -> bool:
    """Whether the server is there: the SDK announces one before it serves."""
    try:
        return bool(client.try_call(AddTwoInts.Request(a=1, b=0), timeout_sec=PATIENCE).sum == 1)
    except ServiceError:
        return False


def test_robolink_calls_what_the_sdk_serves(sdk: Sdk, node: Robot) -> None:
    sdk.ask("serve", service="/from_sdk/add", node="sdk_server")
    client = node.create_client(AddTwoInts, "/from_sdk/add")
    assert client.wait_for_service(PATIENCE)
    until(lambda: can_call(client))
    answers = [client.call_async(AddTwoInts.Request(a=number, b=-(2**62))) for number in range(3)]
    node.spin_until(lambda: all(each.done() for each in answers))
    results: list[Any] = [each.result() for each in answers]
    assert [each.sum for each in results] == [number - 2**62 for number in range(3)]


def test_the_sdk_calls_what_robolink_serves(sdk: Sdk, node: Robot) -> None:
    def add(request: AddTwoInts.Request, response: AddTwoInts.Response) -> AddTwoInts.Response:
        asked.append((request.a, request.b))
        response.sum = request.a + request.b
        return response

    asked: list[tuple[int, int]] = []
    node.create_service(AddTwoInts, "/to_sdk/add", add)
    sdk.ask("client", service="/to_sdk/add", node="sdk_client")
    until(lambda: ["/to_sdk/add", ["example_interfaces/srv/AddTwoInts"]] in sdk.ask("services"))

    def answered() -> bool:
        return (
            node.while_spinning(lambda: sdk.ask("call", service="/to_sdk/add", values={"a": 2**62, "b": -1}))
            is not None
        )

    until(answered)
    assert asked == [(2**62, -1)]
    assert node.while_spinning(lambda: sdk.ask("call", service="/to_sdk/add", values={"a": 40, "b": 2})) == {"sum": 42}
    until(lambda: node.count_clients("/to_sdk/add") == 1)


def test_robolink_lists_the_sdk(sdk: Sdk, node: Robot) -> None:
    sdk.ask(
        "publisher", topic="/ns/out", type_name="geometry_msgs/msg/Twist", node="lister", namespace="/ns", qos=SENSOR
    )
    sdk.ask("subscribe", topic="/in", type_name="sensor_msgs/msg/LaserScan", node="lister_in")
    sdk.ask("serve", service="/listed/add", node="lister_server")
    sdk.ask("client", service="/listed/sum", node="lister_client")
    until(lambda: "/lister_client" in node.get_fully_qualified_node_names() and node.count_clients("/listed/sum"))
    assert {"/ns/lister", "/lister_in", "/lister_server"} <= set(node.get_fully_qualified_node_names())
    assert {("/ns/out", ("geometry_msgs/msg/Twist",)), ("/in", ("sensor_msgs/msg/LaserScan",))} <= {
        (name, tuple(types)) for name, types in node.get_topic_names_and_types()
    }
    assert ("/listed/add", ["example_interfaces/srv/AddTwoInts"]) in node.get_service_names_and_types()
    assert node.get_publisher_names_and_types_by_node("lister", "/ns") == [("/ns/out", ["geometry_msgs/msg/Twist"])]
    assert node.get_subscriber_names_and_types_by_node("lister_in", "/") == [("/in", ["sensor_msgs/msg/LaserScan"])]
    add = "example_interfaces/srv/AddTwoInts"
    assert node.get_service_names_and_types_by_node("lister_server", "/") == [("/listed/add", [add])]
    assert node.get_client_names_and_types_by_node("lister_client", "/") == [("/listed/sum", [add])]


def test_the_sdk_lists_robolink(lab: Lab, sdk: Sdk) -> None:
    with robot(*lab, "listed", "/lab") as node:
        node.create_publisher(Twist, "cmd_vel", qos_profile_sensor_data)
        node.create_subscription(LaserScan, "/scan", print, 7)
        node.create_service(AddTwoInts, "~/add", lambda _, response: response)
        node.create_client(AddTwoInts, "~/ask")
        add, usual = "example_interfaces/srv/AddTwoInts", "::,10:,:,:,,"
        says(sdk, lambda found: ["/lab/listed/ask", [add]] in found and ["/lab/listed/add", [add]] in found, "services")
        says(sdk, lambda found: ["/lab/cmd_vel", ["geometry_msgs/msg/Twist"]] in found, "topics")
        says(sdk, lambda found: ["/scan", ["sensor_msgs/msg/LaserScan"]] in found, "topics")
        place = {"node_name": "listed", "node_namespace": "/lab", "gid": None}
        twist = place | {"topic_type": "geometry_msgs/msg/Twist", "type_hash": type_hash(Twist), "qos": SENSOR}
        says(sdk, {"publishers": [twist], "subscribers": []}.__eq__, "info", topic="/lab/cmd_vel")
        scan = {"topic_type": "sensor_msgs/msg/LaserScan", "type_hash": type_hash(LaserScan), "qos": "::,7:,:,:,,"}
        says(sdk, {"publishers": [], "subscribers": [place | scan]}.__eq__, "info", topic="/scan")
        end = place | {"service_type": add, "type_hash": type_hash(AddTwoInts), "qos": usual}
        says(sdk, {"servers": [end], "clients": []}.__eq__, "service_info", service="/lab/listed/add")
        says(sdk, {"servers": [], "clients": [end]}.__eq__, "service_info", service="/lab/listed/ask")
    until(lambda: not {"/lab/cmd_vel", "/scan"} & dict(sdk.ask("topics")).keys())


@pytest.fixture
def _commands_see_it(lab: Lab, monkeypatch: pytest.MonkeyPatch) -> None:
    put_router_at(monkeypatch, lab.port)
    monkeypatch.setenv("ROS_DOMAIN_ID", str(lab.domain))
    for variable in ("ROBOLINK_NETWORK", "ZENOH_SESSION_CONFIG_URI", "ZENOH_CONFIG_OVERRIDE"):
        monkeypatch.delenv(variable, raising=False)
    if sys.platform == "win32":
        monkeypatch.setenv("ROBOLINK_NETWORK", f"tcp/127.0.0.1:{lab.port}")


@pytest.mark.usefixtures("_commands_see_it")
def test_commands_beside_the_sdk(sdk: Sdk, capsys: pytest.CaptureFixture[str]) -> None:
    sdk.ask("publisher", topic="/shown", type_name="std_msgs/msg/String", node="sdk_shown")
    assert main(["topic", "list", "-t"]) == 0
    assert "/shown [std_msgs/msg/String]" in capsys.readouterr().out.splitlines()
    assert main(["node", "list"]) == 0
    assert "/sdk_shown" in capsys.readouterr().out.splitlines()
    sdk.start("publish", topic="/shown", values={"data": "hello"})
    assert main(["topic", "echo", "--once", "/shown"]) == 0
    assert capsys.readouterr().out == "data: hello\n---\n"
    assert sdk.answer() is None


def test_the_sdk_never_reaches_out(lab: Lab) -> None:
    """Guards the tests themselves: they must run where there is no net."""
    with Sdk(*lab) as sdk, pytest.raises(AssertionError, match="the SDK reaches out"):
        sdk.ask("look_up", type_name="geometry_msgs/msg/Pose")
