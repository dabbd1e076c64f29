"""Generator of docs/development/floors.svg from pyproject.toml, and of rooms.md from the modules' docstrings.

python tools/development_docs.py            writes the picture, and rooms.md into build/docs
python tools/development_docs.py --check    exit code 1 if the picture is out of date
"""

from __future__ import annotations

import ast
import re
import sys
from collections.abc import Iterator
from html import escape
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parent.parent
FOLDER = ROOT / "docs" / "development"
PACKAGE = ROOT / "robolink"
ROOMS = ROOT / "build" / "docs" / "rooms.md"
"""Page that is not committed: every change of a module would be in it."""

RENEW = "python tools/development_docs.py"
"""Command that writes the files again."""

# rooms.md

HEAD = f"""# Rooms

A line for each room and each module: the first sentence of its docstring. `{RENEW}` writes this page.
What may import what is in the picture of the floors, docs/development/README.md.
"""

SUMMARIZED = frozenset(["interfaces"])
"""Rooms of many modules that are all alike: only the room itself is listed."""


def rooms() -> str:
    """Return the text of rooms.md."""
    return "\n".join([HEAD, *_room(PACKAGE, "The root: rclpy's module names")])


def _room(folder: Path, title: str) -> Iterator[str]:
    yield f"## {title}\n"
    files = sorted(each for each in folder.glob("*.py") if each.name != "__init__.py")
    yield f"{first_sentence(folder / '__init__.py')}\n"
    if folder.name in SUMMARIZED:
        return
    if files:
        yield from ("| module | |", "|---|---|")
        yield from (f"| `{each.stem}` | {first_sentence(each).replace('|', chr(92) + '|')} |" for each in files)
        yield ""
    for each in sorted(path.parent for path in folder.glob("*/__init__.py")):
        yield from _room(each, each.relative_to(PACKAGE).as_posix() + "/")


def first_sentence(path: Path) -> str:
    """Return the first sentence of a module's docstring, on one line."""
    docstring = ast.get_docstring(ast.parse(path.read_text(encoding="utf-8"))) or ""
    paragraph = " ".join(docstring.partition("\n\n")[0].split())
    return re.split(r"(?<=[a-z0-9)`\"'][.])\s+(?=[A-Z`\"])", paragraph)[0]


# floors.svg


class Floor(NamedTuple):
    """A floor of the picture: it begins with the layer of pyproject.toml that holds `top`."""

    top: str
    title: str


FLOORS = (
    Floor("cli", "The commands"),
    Floor("testing", "Whole systems: tests, simulated runs, launching"),
    Floor("compat", "Worlds, workspaces, and ROS 2's other packages"),
    Floor("spinning", "What programs build of nodes"),
    Floor("node", "The node"),
    Floor("waitable", "What a node owns"),
    Floor("executors", "Running: contexts, executors, the graph"),
    Floor("transport", "The wire"),
    Floor("parameters", "Settings: parameters, arguments, logging"),
    Floor("topic_endpoint_info", "Words: types, QoS, time"),
    Floor("sim", "Islands: they know no nodes"),
    Floor("expand_topic_name", "The ground: names, files, texts, errors, the system"),
)
"""Floors from the roof down; each begins at the highest layer that belongs to it, see `_begins`."""


def layers() -> list[list[str]]:
    """Return the layers of the whole package as pyproject.toml has them, from the roof down."""
    text = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    contract = text.partition('containers = ["robolink"]')[2]
    found = re.search(r"^layers = (\[.*?^\])", contract, re.DOTALL | re.MULTILINE)
    assert found, "pyproject.toml has no layers of the whole package"
    return [re.split(r"\s*[|:]\s*", re.sub("[()]", "", layer)) for layer in ast.literal_eval(found[1])]


def floors() -> list[tuple[str, list[str]]]:
    """Return each floor's title and its modules, from the roof down."""
    all_layers = layers()
    starts = [_begins(floor, all_layers) for floor in FLOORS]
    assert starts == sorted(starts), "FLOORS are not in the order of pyproject.toml's layers"
    ends = [*starts[1:], len(all_layers)]
    starts[0] = 0
    return [
        (floor.title, [name for layer in all_layers[start:end] for name in layer])
        for floor, start, end in zip(FLOORS, starts, ends, strict=True)
    ]


def _begins(floor: Floor, all_layers: list[list[str]]) -> int:
    for number, layer in enumerate(all_layers):
        if floor.top in layer:
            return number
    raise SystemExit(f"tools/development_docs.py: no layer of pyproject.toml holds {floor.top}: mend FLOORS")


WIDTH, MARGIN, LINE, LETTER = 960, 16, 20, 7.4
"""Sizes of the picture in pixels: its width, its edge, a line of text, a letter of a module's name."""

STYLE = (
    "text{font:14px system-ui,sans-serif;fill:#1c2733}"
    ".title{font-weight:600}"
    ".name{font:12px ui-monospace,Menlo,Consolas,monospace;fill:#33475b}"
)


def picture() -> str:
    """Return the picture of the floors as SVG; it brings its own light background, for dark pages too."""
    body: list[str] = []
    y = MARGIN
    for number, (title, names) in enumerate(floors()):
        lines = list(_wrapped(names, WIDTH - 4 * MARGIN))
        height = 34 + LINE * len(lines)
        body.append(
            f'<rect x="{MARGIN}" y="{y}" width="{WIDTH - 2 * MARGIN}" height="{height}" rx="6" '
            f'fill="hsl(210,50%,{93 - number}%)" stroke="#7c93a8"/>'
        )
        body.append(f'<text class="title" x="{2 * MARGIN}" y="{y + 22}">{escape(title)}</text>')
        for line, text in enumerate(lines):
            body.append(f'<text class="name" x="{2 * MARGIN}" y="{y + 44 + LINE * line}">{escape(text)}</text>')
        y += height + 8
    height = y + 24
    body.append(
        f'<text x="{MARGIN}" y="{height - 12}">A floor imports from the floors below it, never from above.</text>'
    )
    return "\n".join(
        [
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" role="img">',
            "<title>The floors of robolink, from the commands at the top to the ground</title>",
            f"<style>{STYLE}</style>",
            f'<rect width="{WIDTH}" height="{height}" rx="8" fill="#fbfcfd"/>',
            *body,
            "</svg>\n",
        ]
    )


def _wrapped(names: list[str], width: float) -> Iterator[str]:
    line = ""
    for name in names:
        if line and LETTER * len(f"{line}  {name}") > width:
            yield line
            line = ""
        line = f"{line} · {name}" if line else name
    yield line


def written() -> dict[Path, str]:
    """Return the generated files that are committed, and the text of each."""
    return {FOLDER / "floors.svg": picture()}


def write_rooms() -> None:
    """Write the page of all rooms and modules."""
    ROOMS.parent.mkdir(parents=True, exist_ok=True)
    ROOMS.write_text(rooms(), encoding="utf-8", newline="\n")


def is_fresh(path: Path, text: str) -> bool:
    """True if a file is there and has this text."""
    return path.exists() and path.read_text(encoding="utf-8") == text


def main(words: list[str]) -> int:
    """Write the files, or with `--check` compare those that are committed; return the exit code."""
    stale = [path for path, text in written().items() if not is_fresh(path, text)]
    for path in stale:
        if words == ["--check"]:
            sys.stderr.write(f"{path.relative_to(ROOT)} is out of date: {RENEW}\n")
        else:
            path.write_text(written()[path], encoding="utf-8", newline="\n")
    if words != ["--check"]:
        write_rooms()
    return int(bool(stale) and words == ["--check"])


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
