"""The text of a class is an interface file that makes the same class again."""

import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Annotated, Any, ClassVar

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.interfaces import find, names
from robolink.interfaces.geometry_msgs.msg import Point, PointStamped, Quaternion
from robolink.interfaces.std_msgs.msg import Header
from robolink.interfaces.std_srvs.srv import SetBool
from robolink.message import (
    AtMost,
    Message,
    Sequence,
    Service,
    Size,
    byte,
    float32,
    float64,
    int16,
    string,
    type_hash,
    type_name,
    uint8,
)
from robolink.message.base import MessageMeta
from robolink.message.building import build, class_of_description
from robolink.message.definition import parse
from robolink.message.description import described
from robolink.message.text import WIDTH, text_of


def find_full(name: str) -> Any:
    return find(name, name.split("/")[1])


STANDARD = [find_full(name) for kind in ("msg", "srv", "action") for name in names(kind)]


def parts(cls: Any) -> Iterator[Any]:
    if hasattr(cls, "__ros_fields__"):
        yield cls
    for name in ("Request", "Response", "Goal", "Result", "Feedback"):
        if name in cls.__dict__ and isinstance(cls.__dict__[name], type):
            yield cls.__dict__[name]


@pytest.mark.slow
def test_every_standard_type_is_built_of_its_text() -> None:
    for cls in STANDARD:
        is_built_of_its_text(cls)


def is_built_of_its_text(cls: Any) -> None:
    text = text_of(cls)
    made = build(parse(text, type_name(cls)), find_full)
    assert type_hash(made) == type_hash(cls)
    assert described(made) == described(cls)  # the defaults too
    for ours, theirs in zip(parts(cls), parts(made), strict=True):
        assert theirs.__ros_constants__ == ours.__ros_constants__
    assert text_of(made) == text
    assert max(map(len, text.splitlines()), default=0) <= WIDTH


class Wheels(Message, type_name="my_msgs/msg/Wheels"):
    """How fast the wheels turn.

    Forwards is positive::

        left = right = 1.0
    """

    LEFT: ClassVar[uint8] = 1  # the left one
    NAME: ClassVar[string] = "# wheel = \u00e4\n"
    OFF: ClassVar[byte] = b"\x02"

    # As measured,
    # not as asked for.
    left: float64  # [rad/s]
    right: float64 = 0.5
    """Of the other one."""
    names: Annotated[Sequence[Annotated[string, AtMost(5)]], AtMost(3)] = ["a", 'b"']
    octets: Annotated[Sequence[byte], Size(2)] = [b"\x01", b"\x02"]
    on: bool = True
    header: Header
    where: Sequence[Point]


WHEELS = """\
# How fast the wheels turn.
#
# Forwards is positive::
#
#     left = right = 1.0

uint8 LEFT=1  # the left one
string NAME="\\x23 wheel \\x3d \u00e4\\n"
byte OFF=2

# As measured,
# not as asked for.
float64 left  # [rad/s]
# Of the other one.
float64 right 0.5
string<=5[<=3] names ["a", "b\\""]
byte[2] octets [1, 2]
bool on true
std_msgs/Header header
geometry_msgs/Point[] where
"""


def test_what_a_python_class_says() -> None:
    assert text_of(Wheels) == WHEELS
    made: Any = build(parse(WHEELS, "my_msgs/msg/Wheels"), find_full)
    assert made.__ros_constants__ == Wheels.__ros_constants__
    assert made() != Wheels()  # of another class
    assert repr(made()) == repr(Wheels())
    assert made.__doc__.splitlines()[0] == "How fast the wheels turn."


def test_messages_of_the_same_package_go_by_their_bare_name() -> None:
    assert text_of(PointStamped).splitlines()[-2:] == ["std_msgs/Header header", "Point point"]
    assert "float64 w 1.0" in text_of(Quaternion)


class Drive(Service):
    """Drive somewhere."""

    class Request(Message):
        """Where to."""

        goal: Point

    class Response(Message):
        """Whether it came there."""


def test_a_service() -> None:
    assert text_of(Drive) == (
        "# Drive somewhere.\n\n# Where to.\n\ngeometry_msgs/Point goal\n---\n# Whether it came there.\n"
    )
    assert text_of(Drive.Response) == "# Whether it came there.\n"


def test_parts_have_texts_of_their_own() -> None:
    made: Any = build(parse("int16 a\n---\nint16 b # sum", "my_msgs/srv/Add"), find_full)
    assert text_of(made) == "int16 a\n---\nint16 b # sum"
    assert text_of(made.Response) == "int16 b # sum"
    assert text_of(SetBool.Event) == (
        "# Events of SetBool, which service introspection publishes.\n\nservice_msgs/ServiceEventInfo info\n"
        "std_srvs/srv/SetBool_Request[<=1] request\nstd_srvs/srv/SetBool_Response[<=1] response\n"
    )
    event = build(parse(text_of(SetBool.Event), "std_srvs/srv/SetBool_Event"), find_part)
    assert type_hash(event) == type_hash(SetBool.Event)


def find_part(name: str) -> Any:
    short = name.rpartition("_")[2]
    return getattr(SetBool, short) if "SetBool" in name else find_full(name)


def test_a_class_without_source_or_docstring() -> None:
    bare = class_of_description(described(Wheels))
    assert text_of(bare).splitlines()[:2] == ["float64 left", "float64 right 0.5"]


def test_a_source_that_does_not_fit_the_class_is_no_obstacle(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = tmp_path / "changed_since.py"
    file.write_text("from robolink.message import Message, float32\n\nclass Foo(Message):\n    x: float32  # metres\n")
    monkeypatch.syspath_prepend(tmp_path)
    module = __import__("changed_since")
    try:
        file.write_text("\n\nclass Foo(:\n    )")
        assert text_of(module.Foo).splitlines() == ["float32 x"]
    finally:
        del sys.modules["changed_since"]


@given(st.text(st.characters(codec="utf-8", exclude_characters="\0")))
def test_any_docstring_becomes_comments(doc: str) -> None:
    body = {"__module__": "x", "__qualname__": "Foo", "__doc__": doc, "__annotations__": {"x": float32, "y": int16}}
    cls = MessageMeta("Foo", (Message,), body, type_name="my_msgs/msg/Foo")
    made = build(parse(text_of(cls), "my_msgs/msg/Foo"), find_full)
    assert described(made) == described(cls)
