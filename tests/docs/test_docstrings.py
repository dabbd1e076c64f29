"""The docstrings of the package: every public argument is documented, and each docstring names its thing at once."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.support.docstrings import (
    ROOT,
    Undocumented,
    documented,
    file_of,
    module,
    parsed,
    texts,
    undocumented,
    undocumented_fields,
)
from tools.without_annex import is_of_missing

PACKAGE = ROOT / "robolink"

# Public is what users import: of these rooms all (the root is ""), and of the others what their faces name, with the
# methods that it inherits.
WHOLE = (
    "",
    "companions",
    "control",
    "executors.py",
    "geometry",
    "impl/rcutils_logger.py",
    "launch/ros/launch",
    "launch/ros/launch_ros",
    "launch/ros/launch_testing",
    "launch/ros/launch_testing_ros.py",
    "launch/ros/nav2_common.py",
    "launch/ros/webots_ros2_driver.py",
    "sensor_msgs_py",
    "tf2/geometry.py",
)
FACES = (
    "action",
    "faults",
    "launch",
    "lifecycle",
    "message",
    "sim",
    "simulate",
    "supervisor",
    "testing",
    "tf2",
    "workspace",
)

ROOMS = ("", "nodes", *sorted(each.parent.name for each in PACKAGE.glob("*/__init__.py")))
"""Rooms of the package, its root and the nodes that come along: all are looked at."""

EXEMPT: dict[str, str] = {}
"""Functions that need not document their arguments, each with the reason."""

RIDDLE = re.compile(r"(Gives?|Says?|Tells?|What|Whose|Who|Whether|Be|Have|Has|How)\b")
LIKELY = re.compile(rf'"""\s*{RIDDLE.pattern}')
"""What a file has in which a docstring opens so: only such files are parsed, since there are a thousand others."""


def files(room: str) -> list[Path]:
    """The source files of a room."""
    if room == "nodes":
        return sorted((ROOT / room).rglob("*.py"))
    if room.endswith(".py"):
        return [PACKAGE / room]
    found = (PACKAGE / room).glob("*.py") if room == "" else (PACKAGE / room).rglob("*.py")
    return sorted(found)


def missing(room: str) -> list[str]:
    """The public functions of a room that leave arguments undocumented."""
    found = _in_face(room) if room in FACES else _in_files(room)
    own = [each for each in found if room == "" or each.path.is_relative_to(PACKAGE / room)]
    return list(dict.fromkeys(str(each) for each in own if f"{module(each.path).name}.{each.of}" not in EXEMPT))


def _in_files(room: str) -> Iterator[Undocumented]:
    for path in files(room):
        if not path.stem.startswith("_") or path.stem == "__init__":
            yield from undocumented(module(path))
            yield from undocumented_fields(module(path))
    if room == "":
        yield from _in_face(room)


def _in_face(room: str) -> Iterator[Undocumented]:
    """Those among the names that the `__init__.py` of a room imports."""
    names: dict[Path, set[str]] = {}
    for imported, name in module(PACKAGE / room / "__init__.py").imports.values():
        path = file_of(imported)
        if path is not None and path.name != "suggestions.py":
            names.setdefault(path, set()).add(name)
    for path, wanted in sorted(names.items()):
        yield from undocumented(module(path), frozenset(wanted))
        yield from undocumented_fields(module(path), frozenset(wanted))


@pytest.mark.slow
@pytest.mark.parametrize("room", [*WHOLE, *FACES])
def test_every_public_function_documents_all_its_arguments(room: str) -> None:
    assert missing(room) == []


@pytest.mark.parametrize("room", ROOMS)
def test_no_docstring_opens_with_a_riddle(room: str) -> None:
    likely = [path for path in files(room) if LIKELY.search(path.read_text(encoding="utf-8"))]
    assert [str(each) for path in likely for each in texts(path) if RIDDLE.match(each.text)] == []


def test_no_module_opens_with_a_question() -> None:
    """Those that have no docstring are ruff's matter (D100)."""
    sources = {path: path.read_text(encoding="utf-8") for room in ROOMS for path in files(room)}
    question = re.compile(r'(?:#.*\n|\s)*r?"""\s*(What|Whose|Who)\b')
    assert [str(path) for path, text in sources.items() if question.match(text)] == []
    assert len(sources) > 500


def test_each_room_has_files_and_functions() -> None:
    gone = [room for room in (*ROOMS, *WHOLE, *FACES) if not files(room)]
    assert [room for room in gone if not is_of_missing(f"robolink/{room}")] == []
    assert "running" in ROOMS
    face = module(PACKAGE / "testing" / "__init__.py")
    assert face.imports["System"] == ("robolink.testing.system", "System")


# The test's own eyes

SOURCE = '''
"""What a module is."""


class Base:
    def kept(self, one: int) -> None:
        """Keep `one`."""


class Thing(Base):
    """A thing.

    Args:
        size: In metres.
    """

    LIMIT = 3
    """How much."""

    def __init__(self, size: float, colour: str) -> None:
        self.size = size

    def kept(self, one: int) -> None:
        """Keep it."""

    def moved(self, by: float, *rest: int, _own: int = 0, **more: int) -> None:
        """Move ``by`` metres."""

    @property
    def large(self) -> bool:
        """Whether it is."""

    def _own(self, one: int) -> None:
        pass


def made(
    size: float,
    colour: str,
) -> Thing:
    """Make one.

    Args:
        size: In metres,
            colour: no argument, since the line goes on.

    Returns:
        colour: not here.
    """
'''


def test_it_sees_each_undocumented_argument_and_no_other() -> None:
    here = parsed(PACKAGE / "some.py", SOURCE)
    assert [(each.of, *each.arguments) for each in undocumented(here)] == [
        ("made", "colour"),
        ("Thing.__init__", "colour"),
        ("Thing.moved", "rest", "more"),
    ]
    assert [each.of for each in undocumented(here, frozenset({"made"}))] == ["made"]


def test_it_sees_each_undocumented_field_of_a_record() -> None:
    text = """
class Pose(NamedTuple):
    '''Position `x` in metres.'''

    x: float
    y: float
    theta: float
    '''Heading in radians.'''
    _own: int = 0


class Plain:
    y: float
"""
    seen = [(each.of, *each.arguments) for each in undocumented_fields(parsed(PACKAGE / "some.py", text))]
    assert seen == [("Pose", "y")]


def test_it_sees_the_docstrings_of_modules_constants_and_properties(tmp_path: Path) -> None:
    path = tmp_path / "some.py"
    path.write_text(SOURCE)
    seen = [each.text for each in texts(path) if RIDDLE.match(each.text)]
    assert sorted(seen) == ["How much.", "What a module is.", "Whether it is."]


@pytest.mark.parametrize(
    ("text", "names"),
    [
        ("Return `a`, ``b`` and `*c`.", {"a", "b", "c"}),
        ("Return `a.b` and `f(c)`.", {"f"}),
        ("Do.\n\nArgs:\n    a, b: Two.\n    **c: All.\n\nReturns:\n    d: None.", {"a", "b", "c"}),
        ("Do. Args: a: None.", set()),
    ],
)
def test_what_counts_as_documented(text: str, names: set[str]) -> None:
    assert documented(text) == names
