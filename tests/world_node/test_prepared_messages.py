"""Prepared messages: their bytes are those of the messages that they stand for, whatever the names and numbers."""

from __future__ import annotations

import math

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from robolink.image import to_message
from robolink.interfaces.rosgraph_msgs.msg import Clock
from robolink.interfaces.std_msgs.msg import Header
from robolink.interfaces.tf2_msgs.msg import TFMessage
from robolink.message import encode
from robolink.sim import Pose, Scan, Velocity
from robolink.sim.sensors import Lidar
from robolink.world_node.messages import odometry_message, scan_message, transform_message
from robolink.world_node.prepared import (
    PreparedImage,
    PreparedOdometry,
    PreparedScan,
    PreparedTransform,
    Stamp,
    packed_pose,
    transforms_payload,
)

frames = st.text(st.characters(codec="utf-8", exclude_characters="\0"), max_size=20)
times = st.integers(0, 2**31 * 10**9 - 1)
numbers = st.floats(-1e6, 1e6)
headings = st.floats(-math.pi, math.pi)
poses = st.builds(Pose, numbers, numbers, headings)
speeds = st.builds(Velocity, numbers, numbers, numbers)
LIGHT = np.array([0.25, 0.5, 1.0])


@given(times)
def test_a_clock(time: int) -> None:
    assert Stamp.of(time).beginning == encode(Clock(clock=Stamp.of(time).message))


@given(times, frames, st.sampled_from(["rgb8", "mono8", "32FC1"]), st.integers(1, 9), st.integers(1, 9))
def test_an_image(time: int, frame: str, encoding: str, height: int, width: int) -> None:
    stamp, kind = Stamp.of(time), np.float32 if encoding == "32FC1" else np.uint8
    shape = (height, width, 3) if encoding == "rgb8" else (height, width)
    first, second = (np.arange(math.prod(shape)).reshape(shape) * factor % 100 for factor in (1, 7))
    prepared = PreparedImage(to_message(first.astype(kind), encoding, Header(frame_id=frame)))
    wanted = to_message(second.astype(kind), encoding, Header(stamp=stamp.message, frame_id=frame))
    assert prepared.payload(stamp, second.astype(kind)) == encode(wanted)


@given(times, frames, frames, poses, speeds)
def test_odometry(time: int, frame: str, child: str, pose: Pose, twist: Velocity) -> None:
    stamp, prepared = Stamp.of(time), PreparedOdometry(frame, child)
    header = Header(stamp=stamp.message, frame_id=frame)
    assert prepared.payload(stamp, packed_pose(pose), twist) == encode(odometry_message(header, child, pose, twist))
    sure = np.arange(36.0), np.arange(36.0) / 7.0
    wanted = odometry_message(header, child, pose, twist, *sure)
    assert prepared.payload(stamp, packed_pose(pose), twist, *sure) == encode(wanted)


@given(times, st.lists(st.tuples(frames, frames, poses), min_size=1, max_size=5))
def test_transforms(time: int, moved: list[tuple[str, str, Pose]]) -> None:
    stamp = Stamp.of(time)
    wanted = TFMessage(
        transforms=[
            transform_message(Header(stamp=stamp.message, frame_id=frame), child, pose) for frame, child, pose in moved
        ]
    )
    prepared = [(PreparedTransform(frame, child), packed_pose(pose)) for frame, child, pose in moved]
    assert transforms_payload(stamp, prepared) == encode(wanted)


@given(
    times,
    frames,
    st.sampled_from([None, LIGHT]),
    st.lists(st.floats(0.1, 12.0) | st.just(math.inf), min_size=3, max_size=3),
)
def test_scans(time: int, frame: str, light: np.ndarray | None, ranges: list[float]) -> None:
    stamp, lidar = Stamp.of(time), Lidar("scan", beams=3)
    first, scan = (Scan(-1.0, 1.0, 1.0, 0.1, 12.0, np.array(each), light) for each in ([1.0, 2.0, -math.inf], ranges))
    wanted = scan_message(scan, Header(stamp=stamp.message, frame_id=frame), lidar)
    assert PreparedScan(first, frame, lidar).payload(stamp, scan) == encode(wanted)
