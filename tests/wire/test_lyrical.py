"""Cameras and lidars of ROS 2 Lyrical, whose rmw_zenoh sends types that hold a `uint8[]` in its own way."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from typing import Any

import pytest

from robolink import Context, Node
from robolink.cli.main import main
from robolink.cli.topic import meters
from robolink.executors import SingleThreadedExecutor
from robolink.impl.log_output import Record
from robolink.interfaces.builtin_interfaces.msg import Time
from robolink.interfaces.lifecycle_msgs.msg import State, Transition, TransitionEvent
from robolink.interfaces.sensor_msgs.msg import CompressedImage, Image, LaserScan, PointCloud2
from robolink.interfaces.std_msgs.msg import ByteMultiArray, Header, String, UInt8MultiArray
from robolink.interfaces.stereo_msgs.msg import DisparityImage
from robolink.interfaces.unique_identifier_msgs.msg import UUID
from robolink.message import Message, encode
from robolink.message.description import has_buffer_fields
from robolink.qos import DurabilityPolicy, HistoryPolicy, QoSProfile
from robolink.transport.memory import Bus, MemoryTransport
from robolink.wire import EndpointKind, pack_attachment
from tests.support.lyrical_peer import CPU, LyricalPublisher
from tests.support.seen_by_commands import a_node_that_commands_see, latch, press_ctrl_c, spinning, when_said
from tests.support.spins import spin_for, spin_until
from tests.support.transports import Network

pytestmark = pytest.mark.unlike_dds("the second key is of rmw_zenoh: DDS has one topic for all")


class LyricalTransitionEvent(Message, type_name="lifecycle_msgs/msg/TransitionEvent"):
    """Lyrical's: what was `uint64 timestamp` in Kilted and before is a Time."""

    stamp: Time
    transition: Transition
    start_state: State
    goal_state: State


LATCHED = QoSProfile(depth=3, durability=DurabilityPolicy.TRANSIENT_LOCAL)
KEEP_ALL = QoSProfile(history=HistoryPolicy.KEEP_ALL)


def picture(number: int) -> Image:
    return Image(
        header=Header(frame_id=f"camera{number}"), height=1, width=2, encoding="mono8", step=2, data=[number, 7]
    )


@pytest.fixture
def node(net: Network) -> Iterator[Node]:
    context = Context(transport=net.session())
    context.init([], domain_id=0)
    with context:
        yield Node("viewer", context=context)


@pytest.fixture
def viewer(node: Node) -> Iterator[SingleThreadedExecutor]:
    with SingleThreadedExecutor(context=node.context) as executor:
        executor.add_node(node)
        yield executor


@pytest.mark.parametrize(
    ("msg_type", "sent"),
    [
        (Image, [picture(1), picture(2)]),
        (PointCloud2, [PointCloud2(width=1, data=bytes(range(16))), PointCloud2(width=2)]),
        (CompressedImage, [CompressedImage(format="jpeg", data=bytes(300))]),
    ],
)
@pytest.mark.parametrize("first", ["camera", "viewer"])
def test_its_images_and_clouds_are_received(
    net: Network, node: Node, viewer: SingleThreadedExecutor, msg_type: type[Any], sent: list[Any], first: str
) -> None:
    got: list[Any] = []
    session, camera = net.session(), list[LyricalPublisher]()

    def start_camera() -> None:
        camera.append(
            LyricalPublisher(session, "/camera/out", msg_type, on_subscription=lambda camera: camera.put(*sent))
        )

    if first == "camera":
        start_camera()
    subscription = node.create_subscription(msg_type, "camera/out", got.append, 10)
    if first == "viewer":
        start_camera()
    spin_until(viewer, lambda: len(got) >= len(sent))
    assert got[: len(sent)] == sent
    assert camera[0].used == {f"{camera[0].key}/_buf_cpu"}
    assert subscription.malformed == 0
    spin_until(viewer, lambda: subscription.get_publisher_count() == 1)
    (info,) = node.get_publishers_info_by_topic("/camera/out")
    assert (info.node_name, bytes(info.endpoint_gid)) == ("camera_driver", camera[0].gid)


def test_what_it_sends_to_the_usual_key_is_received_too(bus: Bus, context: Context) -> None:
    """So it sends when somebody announces no backends, in its later versions."""
    got: list[Image] = []
    node, executor = Node("viewer", context=context), SingleThreadedExecutor(context=context)
    executor.add_node(node)
    node.create_subscription(Image, "image", got.append, 10)
    camera = LyricalPublisher(MemoryTransport(bus=bus), "/image", Image)
    camera.subscriptions.clear()
    usual = camera.session.advertise(camera.key, LATCHED)
    usual.put(encode(picture(5)), pack_attachment(1, 5, camera.gid))
    spin_until(executor, lambda: got == [picture(5)])


def own_token(bus: Bus, context: Context, msg_type: type[Any], qos: QoSProfile | int = 10) -> list[str]:
    """The fields of the token that a subscription of this type announces."""
    before = set(bus.tokens)
    Node("viewer", context=context).create_subscription(msg_type, "topic", print, qos)
    (token,) = [each for each in set(bus.tokens) - before if "/%topic/" in each]
    return token.split("/")


@pytest.mark.parametrize("qos", [10, LATCHED, KEEP_ALL])
@pytest.mark.parametrize("msg_type", [Image, PointCloud2, CompressedImage, UInt8MultiArray, DisparityImage])
def test_a_subscription_of_such_a_type_says_that_it_takes_main_memory(
    bus: Bus, context: Context, msg_type: type[Any], qos: QoSProfile | int
) -> None:
    assert own_token(bus, context, msg_type, qos)[13:] == [CPU]


@pytest.mark.parametrize("msg_type", [String, LaserScan, ByteMultiArray, UUID])
def test_the_tokens_of_other_types_are_as_ever(bus: Bus, context: Context, msg_type: type[Any]) -> None:
    assert len(own_token(bus, context, msg_type)) == 13
    assert not [key for key in bus.subscriptions if key.endswith("_buf_cpu")]


def test_a_publisher_of_such_a_type_announces_and_sends_as_ever(bus: Bus, context: Context) -> None:
    """Older distributions understand it, and Lyrical's subscriptions listen to the usual key as well."""
    Node("camera", context=context).create_publisher(Image, "topic", 10)
    (own,) = context.graph.endpoints(EndpointKind.PUBLISHER, name="/topic")
    assert own.more == ""
    assert not [key for key in bus.outlets if "_buf" in key]


def test_a_humble_process_names_no_backends(bus: Bus, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROBOLINK_ROS_DISTRO", "humble")
    context = Context(transport=MemoryTransport(bus=bus))
    context.init([], domain_id=0)
    with context:
        assert len(own_token(bus, context, Image)) == 13


def test_only_unbounded_sequences_of_uint8_count() -> None:
    assert has_buffer_fields(Image)
    assert has_buffer_fields(DisparityImage)  # it holds an Image
    assert not has_buffer_fields(UUID)  # uint8[16]
    assert not has_buffer_fields(ByteMultiArray)  # byte[]


def test_a_destroyed_subscription_listens_to_neither_key(bus: Bus, context: Context) -> None:
    node = Node("viewer", context=context)
    node.destroy_subscription(node.create_subscription(Image, "topic", print, 10))
    assert not [key for key, each in bus.subscriptions.items() if each and "Image" in key]


@pytest.mark.parametrize("tells", [True, False])
def test_numbers_that_were_used_for_others_are_no_loss(
    bus: Bus, context: Context, log_lines: list[Record], tells: bool
) -> None:
    """It numbers what it sends to each key in one go; a Jazzy camera's gaps are told as ever."""
    got: list[Image] = []
    node, executor = Node("viewer", context=context), SingleThreadedExecutor(context=context)
    executor.add_node(node)
    subscription = node.create_subscription(Image, "image", got.append, KEEP_ALL)
    if tells:
        publisher = Node("camera", context=context).create_publisher(Image, "image", 10)
        for _ in range(3):
            publisher._attachment()  # numbered, and sent to somebody else
            publisher.publish(picture(1))
    else:
        camera = LyricalPublisher(MemoryTransport(bus=bus), "/image", Image)
        camera.subscriptions.add(f"{camera.token.replace('/MP/', '/MS/').removesuffix(CPU)}backends:cuda:0")
        camera.put(picture(1), picture(2), picture(3))
        assert len(camera.used) == 2
    spin_until(executor, lambda: len(got) == 3)
    spin_for(executor, 0.05)
    assert subscription.lost == (2 if tells else 0)
    assert len(log_lines) == int(tells)


# Commands


@pytest.fixture
def seen(monkeypatch: pytest.MonkeyPatch) -> Iterator[Callable[..., LyricalPublisher]]:
    """Make publishers of Lyrical that commands see."""
    with a_node_that_commands_see(monkeypatch) as node:
        session = MemoryTransport(bus=node.context.transport.bus)  # type: ignore[attr-defined]
        yield lambda *args, **options: LyricalPublisher(session, *args, domain=node.context.get_domain_id(), **options)


def test_commands_list_it(seen: Callable[..., LyricalPublisher], capsys: pytest.CaptureFixture[str]) -> None:
    camera = seen("/camera/image_raw", Image)
    seen("/camera/points", PointCloud2)
    assert main(["topic", "list", "-t"]) == 0
    out = capsys.readouterr().out
    assert "/camera/image_raw [sensor_msgs/msg/Image]\n" in out
    assert "/camera/points [sensor_msgs/msg/PointCloud2]\n" in out
    assert main(["topic", "info", "/camera/image_raw", "-v"]) == 0
    out = capsys.readouterr().out
    assert "Publisher count: 1" in out
    assert "Node name: camera_driver" in out
    assert f"GID: {camera.gid.hex('.')}" in out
    assert main(["node", "info", "/camera_driver"]) == 0
    assert "/camera/points: sensor_msgs/msg/PointCloud2" in capsys.readouterr().out


def test_commands_echo_it(seen: Callable[..., LyricalPublisher], capsys: pytest.CaptureFixture[str]) -> None:
    seen("/image", Image, on_subscription=lambda camera: camera.put(picture(3)))
    assert main(["topic", "echo", "/image", "--once", "--field", "data", "--csv"]) == 0
    assert capsys.readouterr() == ("3,7\n", "")


def test_commands_measure_it(
    seen: Callable[..., LyricalPublisher], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Beside a publisher of the same type that names no backends, too."""
    monkeypatch.setattr(meters, "PERIOD", 0.1)
    when_said(monkeypatch, meters, "say", lambda said: press_ctrl_c(said) if "average rate" in said else None)
    end, camera = threading.Event(), seen("/image", Image)
    plain = camera.token.removesuffix(f"/{CPU}").replace("/camera_driver/", "/another/").replace("/0/1/MP/", "/8/9/MP/")
    camera.session.announce(plain)

    def publish() -> None:
        while not end.wait(0.005):
            camera.put(picture(1))

    thread = threading.Thread(target=publish)
    thread.start()
    try:
        assert main(["topic", "hz", "/image"]) == 130
    finally:
        end.set()
        thread.join()
    assert "average rate: " in capsys.readouterr().out
    assert f"{camera.key}/_buf_cpu" in camera.used


# Types that differ


def test_the_events_of_its_lifecycle_nodes_are_of_another_type_and_that_is_told(
    bus: Bus, context: Context, log_lines: list[Record]
) -> None:
    """They cannot be received as Kilted's and Jazzy's type; nothing fails, and both sides are told."""
    lyrical = Context(transport=MemoryTransport(bus=bus))
    lyrical.init([], domain_id=0)
    with lyrical:
        publisher = Node("arm", context=lyrical).create_publisher(LyricalTransitionEvent, "arm/transition_event", 10)
        node, executor = Node("watcher", context=context), SingleThreadedExecutor(context=context)
        executor.add_node(node)
        got: list[Any] = []
        node.create_subscription(TransitionEvent, "arm/transition_event", got.append, 10)
        publisher.publish(LyricalTransitionEvent())
        spin_for(executor, 0.05)
    assert got == []
    (told,) = [each.message for each in log_lines if each.name == "watcher"]
    assert "subscribes to it as lifecycle_msgs/msg/TransitionEvent, and so /arm publishes it" in told
    assert "bring both to the same version of lifecycle_msgs" in told


def test_the_events_of_its_lifecycle_nodes_are_echoed(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """The command asks the node for the type that it does not have."""
    with a_node_that_commands_see(monkeypatch) as node:
        event = LyricalTransitionEvent(stamp=Time(sec=7), transition=Transition(id=3, label="activate"))
        latch(node, "/arm/transition_event", event)
        with spinning(node):
            code = main(["topic", "echo", "/arm/transition_event", "--once", "--field", "stamp", "--csv"])
        assert code == 0
    assert capsys.readouterr() == ("7,0\n", "")
