"""The messages of the benchmarks as msgspec's Structs: what a program without ROS would send as MessagePack."""

from __future__ import annotations

from typing import Any

import msgspec

from benchmarks.messages.samples import SIDES, pixels, ranges


class Vector(msgspec.Struct):
    x: float
    y: float
    z: float


class PlainTwist(msgspec.Struct):
    linear: Vector
    angular: Vector


class PlainHeader(msgspec.Struct):
    sec: int
    nanosec: int
    frame_id: str


class PlainStamped(msgspec.Struct):
    header: PlainHeader
    twist: PlainTwist


class PlainScan(msgspec.Struct):
    header: PlainHeader
    angle_min: float
    angle_max: float
    angle_increment: float
    time_increment: float
    scan_time: float
    range_min: float
    range_max: float
    ranges: list[float]
    intensities: list[float]


class PlainImage(msgspec.Struct):
    header: PlainHeader
    height: int
    width: int
    encoding: str
    is_bigendian: int
    step: int
    data: bytes


def plain(kind: str) -> Any:
    """A message of this kind; arrays are lists, and an image's are bytes."""
    twist = PlainTwist(Vector(0.3, 0.0, 0.0), Vector(0.0, 0.0, -0.5))
    if kind == "twist":
        return twist
    if kind == "stamped":
        return PlainStamped(PlainHeader(0, 0, ""), twist)
    if kind == "scan":
        return PlainScan(PlainHeader(0, 0, "laser"), 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, ranges(), [])
    width, height, channels, encoding = SIDES[kind]
    return PlainImage(PlainHeader(0, 0, "camera"), height, width, encoding, 0, width * channels, pixels(kind))
