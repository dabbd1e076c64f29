"""Buffers of transforms for tests: filled ones, times, and a look-up in one number."""

from __future__ import annotations

from typing import Any

from robolink.tf2 import (
    BufferCore,
)
from robolink.time import Time

LATEST = Time()


def at(seconds: float) -> Time:
    return Time(seconds=seconds)


def filled(*transforms: Any, static: Any = (), cache_time: Any = None) -> BufferCore:
    buffer = BufferCore(cache_time)
    for each in transforms:
        buffer.set_transform(each, "test")
    for each in static:
        buffer.set_transform_static(each, "test")
    return buffer


def x_of(buffer: BufferCore, target: str, source: str, time: Any = LATEST) -> float:
    return float(buffer.lookup_transform_core(target, source, time).transform.translation.x)
