"""Generator of the pictures on top of the learn pages: each page's own program drives, and a few boxes with arrows.

Usage: python -m tools.docs_site pictures [NAME]...
"""

from __future__ import annotations

import tempfile
from html import escape
from pathlib import Path
from typing import Any, NamedTuple

from robolink.image import to_array
from robolink.image.codecs import png_of
from robolink.testing import System
from tools.docs_site.markdown import blocks
from tools.docs_site.pages import DOCS
from tools.picture import hits, svg

FOLDER = DOCS / "pictures"


class Drive(NamedTuple):
    """A picture of a robot's path: the page whose program drives (or a node's name), the world, seconds."""

    program: str
    world: str
    seconds: float
    page: str = ""
    parameters: dict[str, Any] | None = None


class Boxes(NamedTuple):
    """A picture of nodes: the words in each box, and arrows from box to box with a word on it."""

    boxes: tuple[str, ...]
    arrows: tuple[tuple[int, int, str], ...]


PICTURES: dict[str, Drive | Boxes] = {
    "first_robot": Drive("reactive_controller", "obstacles", 60.0),
    "node": Boxes(("careful", "world"), ()),
    "publish_subscribe": Drive("careful.py", "empty_room", 14.0, "learn/publish_subscribe.md"),
    "laser": Drive("careful.py", "empty_room", 12.0, "learn/laser.md"),
    "pid": Drive("follow.py", "hall.yaml", 32.0, "learn/pid.md", {"kd": 5.0}),
    "launch": Boxes(("team.yaml", "world", "/ada", "/eve"), ((0, 1, ""), (1, 2, "scan"), (2, 3, ""))),
    "see_record": Boxes(("robot", "bag", "follow"), ((0, 1, "/scan"), (1, 2, "/scan"))),
    "testing": Boxes(("test", "careful"), ((0, 1, "/scan"), (1, 0, "/cmd_vel"))),
    "real_robot": Boxes(("laptop", "robot"), ((0, 1, "/cmd_vel"), (1, 0, "/scan"))),
    "ros2_course": Boxes(("rclpy", "world"), ((0, 1, "/cmd_vel"), (1, 0, "/scan"))),
    "why_topic": Boxes(("Publisher", "Subscription"), ((0, 1, "/cmd_vel"),)),
    "why_executor": Boxes(("Zenoh", "queue", "executor", "callback"), ((0, 1, "bytes"), (1, 2, "10"), (2, 3, "Twist"))),
    "why_transports": Boxes(("nodes", "transport", "Zenoh | memory"), ((0, 1, "bytes"), (1, 2, "url"))),
    "services_parameters": Boxes(("you", "careful"), ((0, 1, "/go"), (1, 0, "ok"))),
}
WIDE, HIGH, GAP, TOP = 170, 80, 190, 60
"""Pixels: a box, the room between two of them, and above them."""

XMLNS = 'xmlns="http://www.w3.org/2000/svg"'
TIP = (
    '<defs><marker id="tip" viewBox="0 0 10 10" refX="9" refY="5" markerWidth="7" markerHeight="7" orient="auto">'
    '<path d="M0,0 L10,5 L0,10 z" fill="#1d7fbf"/></marker></defs>'
)
"""The head of an arrow."""


def write(names: list[str]) -> None:
    """Write the named pictures, or all."""
    for name in names or (*PICTURES, "camera"):
        if name == "camera":
            (FOLDER / "camera.png").write_bytes(seen())
            continue
        described = PICTURES[name]
        text = driven(described) if isinstance(described, Drive) else boxes(described)
        (FOLDER / f"{name}.svg").write_text(text, encoding="utf-8")


def driven(described: Drive) -> str:
    """Let a page's program drive in virtual time, and draw its path."""
    with tempfile.TemporaryDirectory() as folder, System(seed=1) as system:
        write_files_of(described.page, Path(folder))
        world, program = (_found(Path(folder), each) for each in (described.world, described.program))
        system.start("world", parameters={"world": world})
        poses, scans = system.messages("/ground_truth"), system.messages("/scan")
        system.start(program, parameters=described.parameters or {})
        system.run(described.seconds)
        path = [(each.pose.pose.position.x, each.pose.pose.position.y) for each in poses]
        last = poses[-1].pose.pose.orientation
        beams = hits(scans[-1], path[-1], (last.z, last.w)) if scans else []
        return svg(world, path, beams, path[-1])


def write_files_of(page: str, folder: Path) -> None:
    """Write the files that a page shows; '' for none."""
    for block in blocks((DOCS / page).read_text(encoding="utf-8")) if page else []:
        if block.title:
            (folder / block.title).write_text(block.text, encoding="utf-8")


def _found(folder: Path, name: str) -> str:
    return str(folder / name) if (folder / name).exists() else name


def seen() -> bytes:
    """Return a PNG of what the camera sees in the world `track`."""
    with System(seed=1) as system:
        system.start("world", parameters={"world": "track"})
        image = system.expect("/camera/image_raw", within=5.0)
    return png_of(to_array(image, "rgb8"))


def boxes(described: Boxes) -> str:
    """Draw nodes as boxes in a row, with arrows above for what goes right and below for what goes left."""
    count = len(described.boxes)
    width, height = count * WIDE + (count - 1) * GAP + 60, HIGH + 2 * TOP
    parts = [
        f'<svg {XMLNS} viewBox="0 0 {width} {height}" font-family="monospace" font-size="20">',
        f'<rect width="{width}" height="{height}" rx="10" fill="#fbfbf8"/>',
        TIP,
    ]
    for number, word in enumerate(described.boxes):
        x = 30 + number * (WIDE + GAP)
        parts.append(f'<rect x="{x}" y="{TOP}" width="{WIDE}" height="{HIGH}" rx="12" fill="#22303c"/>')
        parts.append(_word(x + WIDE / 2, TOP + HIGH / 2 + 7, word, "#ffffff"))
    parts += [_arrow(*each) for each in described.arrows]
    return "\n".join([*parts, "</svg>", ""])


def _word(x: float, y: float, word: str, colour: str) -> str:
    return f'<text x="{x:.0f}" y="{y:.0f}" text-anchor="middle" fill="{colour}">{escape(word)}</text>'


def _arrow(start: int, end: int, word: str) -> str:
    right = end > start
    y = TOP + (24 if right else HIGH - 24)
    left_edge = 30 + min(start, end) * (WIDE + GAP) + WIDE
    right_edge = 30 + max(start, end) * (WIDE + GAP)
    ends = (left_edge + 6, right_edge - 6) if right else (right_edge - 6, left_edge + 6)
    line = f'<path d="M{ends[0]},{y} L{ends[1]},{y}" stroke="#1d7fbf" stroke-width="3" marker-end="url(#tip)"/>'
    return line + _word((left_edge + right_edge) / 2, y - 10 if right else y + 26, word, "#22303c")
