"""Output of the transform between two frames for `robolink tf echo`, like tf2_echo's, and why there is none."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

from robolink.cli.shared.graph import PATIENCE
from robolink.cli.shared.output import say, say_json, tell
from robolink.cli.shared.session import node_of, opened
from robolink.cli.tf.watch import NoTransformsError, Watch
from robolink.exceptions import RobolinkError
from robolink.system import clocks
from robolink.task import Future
from robolink.tf2 import listing
from robolink.tf2.cache import LATEST
from robolink.tf2.exceptions import TransformException
from robolink.tf2.rigid import Rigid

ASKER = "robolink tf"


class RateError(RobolinkError, ValueError):
    """The rate is not a positive number."""


class Wish(NamedTuple):
    """Options of `tf echo`: how often, and until when."""

    rate: float = 1.0
    once: bool = False
    timeout: float | None = None
    json: bool = False


class Found(NamedTuple):
    """Transform from one frame to another."""

    source: str
    target: str
    rigid: Rigid
    stamp: int

    def text(self) -> str:
        """Return it as text, like tf2_echo."""
        place, turn = self.rigid[:3], self.rigid[3:]
        angles = roll_pitch_yaw(*turn)
        return "\n".join(
            [
                f"At time {self.stamp // 10**9}.{self.stamp % 10**9:09d}",
                f"- Translation: {_row(place)}",
                f"- Rotation: in Quaternion {_row(turn)}",
                f"- Rotation: in RPY (radian) {_row(angles)}",
                f"- Rotation: in RPY (degree) {_row([math.degrees(each) for each in angles])}",
                "- Matrix:",
                *("".join(f" {_short(each):>6}" for each in row) for row in matrix(self.rigid)),
            ]
        )

    def data(self) -> dict[str, Any]:
        """Return it as data for JSON."""
        return {
            "stamp": self.stamp / 1e9,
            "frame_id": self.source,
            "child_frame_id": self.target,
            "translation": dict(zip("xyz", self.rigid[:3], strict=True)),
            "rotation": dict(zip("xyzw", self.rigid[3:], strict=True)),
            "rpy": roll_pitch_yaw(*self.rigid[3:]),
        }


def run(source: str, target: str, wish: Wish) -> None:
    """Show where a frame is in another, until Ctrl-C; raises NoTransformsError when --timeout passes before."""
    if not (math.isfinite(wish.rate) and wish.rate > 0):
        raise RateError(f"RATE: expected a number of Hz above 0, got {wish.rate:g}")
    with opened() as context:
        watch = Watch(node_of(context))
        _wait(watch, source, target, wish.timeout)
        while True:
            _show(watch, source, target, json=wish.json)
            if wish.once:
                return
            watch.listen(1.0 / wish.rate)


def _wait(watch: Watch, source: str, target: str, timeout: float | None) -> None:
    """Wait for the first transform; print after a second why there is none, again if the reason changes."""
    begin, told = clocks.monotonic(), ""
    came: Future[None] = Future()

    def look() -> None:
        if not came.done() and why_not(watch, source, target) == "":
            came.set_result(None)

    watch.on_news = look
    while not came.done():
        left = math.inf if timeout is None else timeout - (clocks.monotonic() - begin)
        if left <= 0:
            raise NoTransformsError(f"gave up after {timeout:g} s: {why_not(watch, source, target)}")
        watch.listen(min(PATIENCE, left), came)
        why = why_not(watch, source, target)
        if why not in ("", told) and left > PATIENCE:
            tell(why if why.startswith("waiting") else f"waiting: {why}")
            told = why
    watch.on_news = None


def why_not(watch: Watch, source: str, target: str) -> str:
    """Return the reason why there is no transform between two frames; empty if there is one."""
    if not watch.links:
        return watch.why_nothing()
    try:
        for frame in (source, target):
            watch.tree.check(frame, ASKER)
        watch.tree.path(source, target, LATEST, ASKER)
    except TransformException as error:
        return str(error)
    return ""


def _show(watch: Watch, source: str, target: str, *, json: bool) -> None:
    try:
        found = Found(source, target, *watch.tree.transform(source, target, LATEST, ASKER))
    except TransformException as error:  # there was one: the tree has changed
        text = f"Failure at {clocks.time_of_day():.6f}\nException thrown:{error}\nThe current list of frames is:"
        say_json({"error": str(error)}) if json else say(f"{text}\n{listing.as_text(watch.tree.caches)}")
        return
    say_json(found.data()) if json else say(found.text())


def roll_pitch_yaw(x: float, y: float, z: float, w: float) -> tuple[float, float, float]:
    """Return the angles of a unit quaternion about the static axes x, y and z, in radians."""
    sine = 2.0 * (w * y - x * z)
    if abs(sine) > 1.0 - 1e-12:  # straight up or down: roll and yaw are one, which roll has
        return 2.0 * math.atan2(x, w), math.copysign(math.pi / 2, sine), 0.0
    roll = math.atan2(2.0 * (w * x + y * z), 1.0 - 2.0 * (x * x + y * y))
    return roll, math.asin(sine), math.atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))


def matrix(rigid: Rigid) -> list[list[float]]:
    """Return the 4x4 matrix of a transform, row by row."""
    px, py, pz, x, y, z, w = rigid
    return [
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - z * w), 2.0 * (x * z + y * w), px],
        [2.0 * (x * y + z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - x * w), py],
        [2.0 * (x * z - y * w), 2.0 * (y * z + x * w), 1.0 - 2.0 * (x * x + y * y), pz],
        [0.0, 0.0, 0.0, 1.0],
    ]


def _row(numbers: Sequence[float]) -> str:
    return f"[{', '.join(map(_short, numbers))}]"


def _short(number: float) -> str:
    return f"{round(number, 3) + 0.0:.3f}"  # no -0.000
