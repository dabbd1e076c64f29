"""Benchmark of tf2: storing and looking up a chain of ten moving frames, beside numpy and scipy in the same run.

    python benchmarks/tf2.py [--rounds 5]

The peers do the same maths and nothing else: for each frame a search in its stamps, the arc between two quaternions,
and the product of ten transforms. They have no names, no tree, no checks and no messages.
"""

from __future__ import annotations

import argparse
import math
import statistics
import timeit
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation, Slerp

from robolink.interfaces.geometry_msgs.msg import TransformStamped
from robolink.tf2 import BufferCore
from robolink.time import Time

FRAMES, STAMPS, CALLS = 10, 500, 1000
STEP = 10_000_000
"""Nanoseconds from one transform of a frame to the next: 100 Hz."""


def sample(frame: int, at: int) -> TransformStamped:
    """A frame that moves on a circle in the one before it."""
    made = TransformStamped(child_frame_id=f"f{frame + 1}")
    made.header.frame_id = f"f{frame}"
    made.header.stamp = Time(nanoseconds=(at + 1) * STEP).to_msg()
    angle = 0.01 * at + frame
    made.transform.translation.x, made.transform.translation.y = math.cos(angle), math.sin(angle)
    made.transform.rotation.z, made.transform.rotation.w = math.sin(angle / 2), math.cos(angle / 2)
    return made


def filled() -> BufferCore:
    """A buffer with all of them."""
    buffer = BufferCore()
    for at in range(STAMPS):
        for frame in range(FRAMES):
            buffer.set_transform(sample(frame, at), "benchmark")
    return buffer


class Peer:
    """The same transforms as arrays."""

    def __init__(self) -> None:
        self.stamps = np.arange(1, STAMPS + 1, dtype=np.int64) * STEP
        moved, turned = [], []
        for frame in range(FRAMES):
            transforms = [sample(frame, at).transform for at in range(STAMPS)]
            moved.append([(t.translation.x, t.translation.y, t.translation.z) for t in transforms])
            turned.append([(t.rotation.x, t.rotation.y, t.rotation.z, t.rotation.w) for t in transforms])
        self.places, self.turns = np.array(moved), np.array(turned)

    def around(self, time: int) -> tuple[list[int], list[float]]:
        """For each frame, the last stamp before a time and how far it is to the next: one search each, as in a tree."""
        found = [int(np.searchsorted(self.stamps, time, "right")) - 1 for _ in range(FRAMES)]
        return found, [(time - int(self.stamps[at])) / STEP for at in found]

    def numpy(self, time: int) -> NDArray[Any]:
        """Look up the chain: all frames at once as far as it goes, then the product."""
        found, ratios = self.around(time)
        rows, index, ratio = np.arange(FRAMES), np.array(found), np.array(ratios)[:, None]
        one, other = self.turns[rows, index], self.turns[rows, index + 1]
        dot = (one * other).sum(axis=1, keepdims=True)
        half = np.arccos(np.clip(np.abs(dot), -1.0, 1.0))
        turn = (np.sin((1 - ratio) * half) * one + np.sin(ratio * half) * other * np.sign(dot)) / np.sin(half)
        x, y, z, w = turn.T
        matrices = np.zeros((FRAMES, 4, 4))
        matrices[:, 0, 0], matrices[:, 0, 1] = 1 - 2 * (y * y + z * z), 2 * (x * y - z * w)
        matrices[:, 0, 2], matrices[:, 1, 0] = 2 * (x * z + y * w), 2 * (x * y + z * w)
        matrices[:, 1, 1], matrices[:, 1, 2] = 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)
        matrices[:, 2, 0], matrices[:, 2, 1] = 2 * (x * z - y * w), 2 * (y * z + x * w)
        matrices[:, 2, 2], matrices[:, 3, 3] = 1 - 2 * (x * x + y * y), 1.0
        matrices[:, :3, 3] = (1 - ratio) * self.places[rows, index] + ratio * self.places[rows, index + 1]
        product: NDArray[Any] = matrices[0]
        for each in matrices[1:]:
            product = product @ each
        return product

    def scipy(self, time: int) -> NDArray[Any]:
        """Look up the chain frame by frame, as a program would that has scipy and no tf2."""
        product = np.identity(4)
        for frame, (at, ratio) in enumerate(zip(*self.around(time), strict=True)):
            between = Slerp([0.0, 1.0], Rotation.from_quat(self.turns[frame, at : at + 2]))
            each = np.identity(4)
            each[:3, :3] = between(ratio).as_matrix()
            each[:3, 3] = (1 - ratio) * self.places[frame, at] + ratio * self.places[frame, at + 1]
            product = product @ each
        return product


def check(buffer: BufferCore, peer: Peer, time: int) -> None:
    """See that all three give the same."""
    found = buffer.lookup_transform_core("f0", f"f{FRAMES}", Time(nanoseconds=time)).transform
    place = [found.translation.x, found.translation.y, found.translation.z]
    for matrix in (peer.numpy(time), peer.scipy(time)):
        assert np.allclose(matrix[:3, 3], place)
        turn = found.rotation
        assert np.allclose(matrix[:3, :3], Rotation.from_quat([turn.x, turn.y, turn.z, turn.w]).as_matrix())


def main() -> None:
    """Measure, taking turns."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rounds", type=int, default=5)
    rounds = parser.parse_args().rounds
    buffer, taking, peer, time = filled(), filled(), Peer(), 2 * STEP * STAMPS // 3 + 3_333_333
    check(buffer, peer, time)
    options, last = Time(nanoseconds=time), f"f{FRAMES}"
    new = iter([sample(FRAMES - 1, at) for at in range(STAMPS, STAMPS + rounds * CALLS)])
    programs: dict[str, Callable[[], Any]] = {
        "lookup between two stamps": lambda: buffer.lookup_transform_core("f0", last, options),
        "  the same by numpy": lambda: peer.numpy(time),
        "  the same by scipy": lambda: peer.scipy(time),
        "lookup of the latest": lambda: buffer.lookup_transform_core("f0", last, Time()),
        "lookup of one frame in its parent": lambda: buffer.lookup_transform_core("f0", "f1", options),
        "can_transform": lambda: buffer.can_transform_core("f0", last, options),
        "set_transform": lambda: taking.set_transform(next(new), "benchmark"),
    }
    figures: dict[str, list[float]] = {name: [] for name in programs}
    for _ in range(rounds):
        for name, program in programs.items():
            figures[name].append(timeit.timeit(program, number=CALLS) / CALLS)
    print(f"a chain of {FRAMES} frames, {STAMPS} transforms of each; medians of {rounds} rounds of {CALLS}")
    for name, found in figures.items():
        middle = statistics.median(found)
        print(f"{name:<36} {middle * 1e6:8.1f} us {1 / middle:10.0f} /s")


if __name__ == "__main__":
    main()
