"""All that the page draws of a simulated world reaches Foxglove in standard types, with schemas that describe them."""

from __future__ import annotations

import json
import re
import subprocess
import threading
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

from robolink.executors import SingleThreadedExecutor
from robolink.interfaces.nav2_msgs.msg import Particle, ParticleCloud
from robolink.interfaces.nav_msgs.msg import OccupancyGrid
from robolink.parameter import Parameter
from robolink.qos import DurabilityPolicy, QoSProfile
from robolink.serialization import serialize_message
from tests.support import node_modules
from tests.support.nodefiles import load_node_file
from tests.support.view_clients import WITHIN, Shown, shown

SCRIPT = Path(__file__).with_name("foxglove_world.mjs")
LAYERS = Path(__file__).parents[3] / "robolink" / "view" / "page" / "panels" / "world_layers.js"
REFERENCE = Path(__file__).parents[3] / "docs" / "reference" / "view.md"

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)

TYPES = {
    "/world/floor": "visualization_msgs/msg/MarkerArray",
    "/world/walls": "visualization_msgs/msg/MarkerArray",
    "/world/objects": "visualization_msgs/msg/MarkerArray",
    "/scan": "sensor_msgs/msg/LaserScan",
    "/odom": "nav_msgs/msg/Odometry",
    "/tf": "tf2_msgs/msg/TFMessage",
    "/tf_static": "tf2_msgs/msg/TFMessage",
    "/camera/image_raw": "sensor_msgs/msg/Image",
    "/camera/image_raw/compressed": "sensor_msgs/msg/CompressedImage",
    "/camera/camera_info": "sensor_msgs/msg/CameraInfo",
}


@contextmanager
def signs() -> Iterator[Shown]:
    """The world `signs` as it runs, with a view of it."""
    with shown() as system:
        parameters = [Parameter("world", value="signs")]
        world = load_node_file("world").SimulatedWorld(context=system.context, parameter_overrides=parameters)
        executor = SingleThreadedExecutor(context=system.context)
        executor.add_node(world)
        thread = threading.Thread(target=executor.spin)
        thread.start()
        try:
            yield system
        finally:
            executor.shutdown()
            thread.join(WITHIN)
            world.destroy_node()


def check(found: dict[str, Any]) -> None:
    """Check the decoded messages of the topics, whose numbers and points are only counted."""
    floor, walls, objects = (found[f"/world/{name}"]["markers"] for name in ("floor", "walls", "objects"))
    assert Counter(each["ns"] for each in floor) == {"": 1, "floor": 1, "paint": 5}
    counted = Counter(each["ns"] for each in walls)
    assert counted == {"": 1, "walls": 2, "wall_faces": 2, "obstacles": 1, "signs": 10, "poles": 5}
    assert {each["text"] for each in walls if each["ns"] == "signs"} >= {"stop", "36h11/0", "36h11/2"}
    assert all(each["points"] == each["colors"] > 50 for each in walls if each["ns"] == "signs")
    assert [(each["ns"], each["header"]["frame_id"]) for each in objects[1:]] == [("robots", "base_link")]
    assert found["/scan"]["ranges"] == 180
    assert (found["/camera/image_raw"]["width"], found["/camera/image_raw"]["data"]) == (640, 640 * 480 * 3)
    assert (found["/camera/camera_info"]["width"], found["/camera/camera_info"]["k"]) == (640, 9)
    assert found["/camera/image_raw/compressed"]["format"].startswith("rgb8; jpeg")
    frames = {each["child_frame_id"] for topic in ("/tf", "/tf_static") for each in found[topic]["transforms"]}
    assert {"odom", "base_link"} <= frames


@pytest.mark.processes
def test_foxgloves_client_reads_all_of_a_simulated_world() -> None:
    node_modules.need("@foxglove/ws-protocol", "@foxglove/rosmsg", "@foxglove/rosmsg2-serialization", "ws")
    with signs() as system:
        command = node_modules.command(SCRIPT, f"ws://127.0.0.1:{system.view.port}/", *TYPES)
        environment = node_modules.environment()
        ran = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=60, check=False)
    assert ran.returncode == 0, ran.stderr
    found = json.loads(ran.stdout)
    assert {topic: each["schemaName"] for topic, each in found.items()} == TYPES
    assert {each["encoding"] for each in found.values()} == {"cdr"}
    check({topic: each["message"] for topic, each in found.items()})


@pytest.mark.slow
def test_schemas_of_a_simulated_world_are_whole_and_of_standard_packages() -> None:
    rosbags = pytest.importorskip("rosbags.typesys")
    with signs() as system, system.client("foxglove.sdk.v1", token=False) as client:
        found, store = {}, rosbags.get_typestore(rosbags.Stores.EMPTY)
        for topic, name in TYPES.items():
            channel = client.channel(topic)
            assert (channel["schemaName"], channel["schemaEncoding"], channel["encoding"]) == (name, "ros2msg", "cdr")
            assert "robolink" not in channel["schema"]
            if name not in store.types:
                store.register(rosbags.get_types_from_msg(channel["schema"], name))
            message = store.deserialize_cdr(client.next(client.subscribe(topic)), name)
            found[topic] = told(message)
    check(found)


def test_what_a_navigation_publishes_reaches_others_with_whole_schemas() -> None:
    cloud = ParticleCloud(particles=[Particle(weight=0.25), Particle(weight=0.75)])
    costmap = OccupancyGrid(data=[0, 99, 100, -1])
    costmap.info.width = costmap.info.height = 2
    with shown() as system, system.client("foxglove.sdk.v1", token=False) as client:
        for message, topic in ((cloud, "/particle_cloud"), (costmap, "/global_costmap/costmap")):
            publisher = system.node.create_publisher(type(message), topic, LATCHED)
            publisher.publish(message)
            channel = client.channel(topic)
            assert channel["schemaName"] == type(message).__ros_type__
            assert serialize_message(message) == client.next(client.subscribe(topic))
        assert "MSG: nav2_msgs/Particle\n" in client.channel("/particle_cloud")["schema"]


def told(value: Any, key: str = "") -> Any:
    """A message as a dict, with the lengths of its arrays of numbers, points and colours in place of them."""
    if key in ("points", "colors") or hasattr(value, "dtype"):
        return len(value)
    if isinstance(value, list):
        return [told(each) for each in value]
    if hasattr(value, "__msgtype__"):
        return {name: told(each, name) for name, each in vars(value).items()}
    return value


def test_the_reference_names_each_type_that_the_page_draws() -> None:
    kinds = LAYERS.read_text(encoding="utf-8").partition("export const KINDS = {")[2].partition("};")[0]
    drawn = set(re.findall(r'"(\w+/msg/\w+)"', kinds))
    assert len(drawn) > 10
    table = REFERENCE.read_text(encoding="utf-8").partition("| on the page |")[2].partition("\n\n")[0]
    assert set(re.findall(r"`(\w+_msgs/\w+)`", table)) >= {each.replace("/msg/", "/") for each in drawn}
    assert "robolink_interfaces" not in table
