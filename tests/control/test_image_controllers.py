"""Nodes that drive by a camera: without images, with bad ones, at their end, and what their parameters say."""

from __future__ import annotations

from typing import Any

import pytest

from robolink import Node, Parameter
from robolink.exceptions import InvalidParameterValueException
from robolink.image import to_message
from robolink.interfaces.geometry_msgs.msg import Twist
from robolink.interfaces.sensor_msgs.msg import Image
from robolink.logging import LoggingSeverity
from robolink.testing import System
from tests.support.cameras import BAD, RED, YELLOW, Camera, floor, thing
from tests.support.nodefiles import load_node_file

line, blobs = load_node_file("line_follower"), load_node_file("blob_chaser")
SEEN = {
    line.LineFollower: floor((YELLOW, slice(75, 85))),
    blobs.BlobChaser: thing(RED, slice(40, 60), slice(75, 85)),
}
"""For each controller an image on which it drives ahead."""
BOTH = pytest.mark.parametrize("controller", SEEN)


def warnings(system: System) -> list[str]:
    return [each.message for each in system.logs if each.severity >= LoggingSeverity.WARN]


def driving(system: System, controller: type[Node], **parameters: Any) -> tuple[Camera, Any]:
    """Start a camera, and a controller that drives by what it sees."""
    camera, node = system.start(Camera), system.start(controller, parameters=parameters)
    camera.show(SEEN[controller])
    system.run(1.05)
    assert camera.heard[-1].linear.x > 0.05
    return camera, node


@BOTH
def test_every_parameter_says_what_it_is_and_which_values_it_takes(system: System, controller: type[Node]) -> None:
    node = system.start(controller)
    own = set(node.list_parameters([], 0).names) - {"use_sim_time", "start_type_description_service"}
    assert own > {"speed", "turn_speed", "kp", "hue_tolerance", "timeout"}
    for name in own:
        descriptor, value = node.describe_parameter(name), node.get_parameter(name).value
        assert descriptor.description
        assert not descriptor.read_only
        if name == "colours":
            assert descriptor.additional_constraints.startswith("red, ")
        else:
            limits = (descriptor.floating_point_range or descriptor.integer_range)[0]
            assert limits.from_value <= value <= limits.to_value


@BOTH
def test_a_value_that_cannot_be_is_refused(system: System, controller: type[Node]) -> None:
    node = system.start(controller)
    for name, value in (("speed", -1.0), ("speed", float("nan")), ("kp", -0.1), ("hue_tolerance", 0)):
        (result,) = node.set_parameters([Parameter(name, value=value)])
        assert not result.successful
        assert name in result.reason
    with pytest.raises(InvalidParameterValueException, match="speed"):
        system.start(controller, parameters={"speed": 99.0})


@BOTH
def test_without_images_it_stops_once_and_says_so_and_goes_on_with_the_next(
    system: System, controller: type[Node]
) -> None:
    camera, _ = driving(system, controller)
    count = len(camera.heard)
    camera.show(None)
    system.run(0.9)
    assert len(camera.heard) == count
    system.run(5.0)
    assert camera.heard[count:] == [Twist()]
    assert warnings(system) == ["no image on /camera/image_raw for 1 s: the robot stands until one comes"]
    camera.show(SEEN[controller])
    system.run(1.0)
    assert camera.heard[-1].linear.x > 0.05


@BOTH
def test_a_robot_that_nobody_drives_is_left_alone(system: System, controller: type[Node]) -> None:
    camera = system.start(Camera)
    camera.show(None)
    node = system.start(controller)
    system.run(4.9)  # a world may take that long to start beside it
    assert warnings(system) == []
    system.run(10.0)
    assert warnings(system) == ["no image on /camera/image_raw for 5 s: the robot stands until one comes"]
    node.destroy_node()
    system.run(0.1)
    assert camera.heard == []


@BOTH
@pytest.mark.parametrize(("image", "words"), BAD.values(), ids=BAD)
def test_a_bad_image_stops_it_and_is_told_once(
    system: System, controller: type[Node], image: Image, words: str
) -> None:
    camera, _ = driving(system, controller)
    count = len(camera.heard)
    camera.show(image)
    system.run(4.0)
    assert camera.heard[count:] == [Twist()]
    (warning,) = warnings(system)
    assert warning.startswith("/camera/image_raw: ")
    assert words in warning
    assert warning.endswith(": the robot stands until a good image comes")
    camera.show(SEEN[controller])
    system.run(1.0)
    assert camera.heard[-1].linear.x > 0.05


@BOTH
def test_good_and_bad_images_by_turns_do_not_flood_the_log(system: System, controller: type[Node]) -> None:
    camera, _ = driving(system, controller)
    for _ in range(20):
        camera.show(Image(encoding="bgr8"))
        system.run(0.1)
        camera.show(SEEN[controller])
        system.run(0.1)
    assert len(warnings(system)) == 1


@BOTH
@pytest.mark.parametrize("size", [(1, 1), (1, 160), (120, 1), (2, 3)])
def test_images_of_any_size_are_looked_at(system: System, controller: type[Node], size: tuple[int, int]) -> None:
    camera, _ = driving(system, controller)
    for colour in (RED, YELLOW):
        camera.show(floor((colour, slice(None)), height=size[0], width=size[1]))
        system.run(0.5)
    assert warnings(system) == []


@BOTH
@pytest.mark.parametrize("encoding", ["rgb8", "bgra8", "rgba8", "bgr16"])
def test_any_encoding_of_colours_will_do(system: System, controller: type[Node], encoding: str) -> None:
    camera, node = driving(system, controller)
    expected = camera.heard[-1]
    shown = to_message(SEEN[controller], "bgr8")
    converted = node.bridge.imgmsg_to_cv2(shown, encoding)
    camera.show(converted, encoding)
    system.run(1.0)
    assert camera.heard[-1].linear.x == pytest.approx(expected.linear.x)


@BOTH
def test_without_stamps_it_drives_as_well(system: System, controller: type[Node]) -> None:
    camera = system.start(Camera)
    camera.is_stamped = False
    camera.show(SEEN[controller])
    system.start(controller)
    system.run(3.05)
    assert camera.heard[-1].linear.x > 0.05
    assert warnings(system) == []


@BOTH
def test_it_stops_the_robot_when_it_is_destroyed_or_its_context_ends(system: System, controller: type[Node]) -> None:
    camera, node = driving(system, controller)
    node.destroy_node()
    node.destroy_node()
    system.run(0.2)
    assert camera.heard[-1] == Twist()
    other = system.start(controller, name="other")
    system.run(0.5)
    assert camera.heard[-1].linear.x > 0.05
    system.stop(other)
    system.run(0.01)
    assert camera.heard[-1] == Twist()


@BOTH
def test_what_it_sees_is_published_while_somebody_looks(system: System, controller: type[Node]) -> None:
    driving(system, controller)
    name = {line.LineFollower: "line_follower", blobs.BlobChaser: "blob_chaser"}[controller]
    images = list[Image]()
    system.node.create_subscription(Image, f"/{name}/image", images.append, 10)
    system.run(0.5)
    assert len(images) >= 3
    assert (images[-1].width, images[-1].encoding) == (160, "bgr8")
    assert images[-1].header.frame_id == "camera_optical_frame"
    assert bytes(images[-1].data) != SEEN[controller].tobytes()  # something is drawn on it
