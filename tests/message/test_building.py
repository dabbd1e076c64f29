"""Classes built at run time, of texts and of descriptions, are the classes that Python code would have made."""

from array import array
from collections.abc import Callable
from typing import Annotated, Any, ClassVar

import pytest

from robolink.exceptions import DefinitionError, MessageError
from robolink.interfaces.diagnostic_msgs.msg import DiagnosticStatus
from robolink.interfaces.geometry_msgs.msg import Point, Twist
from robolink.interfaces.std_msgs.msg import Header
from robolink.message import (
    Action,
    AtMost,
    Message,
    Sequence,
    Service,
    Size,
    decode,
    encode,
    float32,
    float64,
    string,
    type_hash,
    uint8,
)
from robolink.message.base import MessageMeta
from robolink.message.building import build
from robolink.message.class_factory import weight
from robolink.message.definition import parse
from robolink.message.description import (
    described,
)
from tests.support.built_types import built, field, find_full

# Of texts.


def point_of_mine(name: str) -> Any:
    return built("float64 z", "my_msgs/msg/Point") if name == "my_msgs/msg/Point" else find_full(name)


def test_a_message() -> None:
    foo = built(
        "# What it is.\nuint8 LEFT=1\nbyte OFF=2\n"
        "float64 speed 0.5\nint16[] steps [1, 2]\nbyte[2] two [3, 4]\nPoint at",
        resolve=point_of_mine,
    )
    assert (foo.__name__, foo.__module__, foo.__ros_type__) == ("Foo", "my_msgs.msg", "my_msgs/msg/Foo")
    assert foo.__doc__ == "What it is."
    assert (foo.LEFT, foo.OFF) == (1, b"\x02")
    assert list(foo.__ros_constants__) == ["LEFT", "OFF"]
    made = foo()
    assert (made.speed, made.steps, made.two) == (0.5, array("h", [1, 2]), [b"\x03", b"\x04"])
    made.steps.append(3)
    assert foo().steps == array("h", [1, 2])
    assert decode(foo, encode(made)) == made
    assert made.at.z == 0.0
    assert foo.get_fields_and_field_types()["at"] == "my_msgs/Point"


def test_it_is_what_python_code_makes() -> None:
    class Written(Message, type_name="my_msgs/msg/Foo"):
        """What it is."""

        LEFT: ClassVar[uint8] = 1
        header: Header
        speed: float64 = 0.5
        few: Annotated[Sequence[Annotated[string, AtMost(5)]], AtMost(3)]
        where: Annotated[Sequence[Point], Size(2)]

    foo = built("uint8 LEFT=1\nHeader header\nfloat64 speed 0.5\nstring<=5[<=3] few\ngeometry_msgs/Point[2] where")
    assert described(foo) == described(Written)
    assert foo.__ros_constants__ == Written.__ros_constants__
    assert foo.__ros_fields__ == Written.__ros_fields__
    assert foo().header == Header()


def test_a_service() -> None:
    cls = built("# Adds.\nint32 a\nuint8 X=1\n---\n# The sum.\nint32 sum 3", "my_msgs/srv/Add")
    assert issubclass(cls, Service)
    assert (cls.__name__, cls.__module__, cls.__doc__) == ("Add", "my_msgs.srv", "Adds.")
    assert (cls.__ros_type__, cls.Request.__ros_type__) == ("my_msgs/srv/Add", "my_msgs/srv/Add_Request")
    assert (cls.Event.__ros_type__, cls.Response.__doc__) == ("my_msgs/srv/Add_Event", "The sum.")
    assert (cls.Request.X, cls.Response().sum) == (1, 3)


def test_an_action() -> None:
    cls: Any = built("int32 order\n---\nint32[] sequence\n---\nint32[] partial", "my_msgs/action/Count")
    assert issubclass(cls, Action)
    assert [each.__ros_type__ for each in (cls, cls.Goal, cls.Result, cls.Feedback)] == [
        "my_msgs/action/Count",
        "my_msgs/action/Count_Goal",
        "my_msgs/action/Count_Result",
        "my_msgs/action/Count_Feedback",
    ]
    assert cls.Impl.SendGoalService.Request.__ros_type__ == "my_msgs/action/Count_SendGoal_Request"
    assert type_hash(cls).startswith("RIHS01_")


def test_a_bare_header_is_the_packages_own_first() -> None:
    own = built("int32 x", "my_msgs/msg/Header")
    assert built("Header h")().h == Header()
    assert type(built("Header h", resolve=lambda name: {"my_msgs/msg/Header": own}[name])().h) is own


def test_names_that_python_keeps_for_itself_are_fields() -> None:
    text = "float64 from\nint32[] class\nstring in\nbool is\nHeader import\nint32[2] lambda\nstring[] m\nint32 self"
    foo = built(text)
    given_values = {"from": 1.0, "class": [1], "in": "x", "is": True, "lambda": [1, 2], "m": ["y"], "self": 5}
    made = foo(**given_values)
    back = decode(foo, encode(made))
    assert back == made
    assert getattr(back, "from") == 1.0
    assert list(getattr(back, "class")) == [1]
    with pytest.raises(MessageError, match=r"Foo\.in: expected string, got 3"):
        encode(foo(**{"in": 3}))


def test_a_type_that_is_not_there_is_named_with_its_place() -> None:
    with pytest.raises(DefinitionError) as raised:
        built("int32 a\n  geometry_msgs/Piont b")
    assert str(raised.value) == "Foo:2:3: no message type named 'Piont' in geometry_msgs (did you mean 'Point'?)"
    with pytest.raises(DefinitionError, match=r"^Foo:1:1: no interface package named 'my_msgs'"):
        built("Piont b")


@pytest.mark.parametrize(
    ("text", "error"),
    [
        ("uint8[99999999] a", "Foo: my_msgs/msg/Foo has fixed arrays of 100000"),
        ("geometry_msgs/Point[999999] a", "Foo: my_msgs/msg/Foo has fixed arrays of"),
        ("\n".join(f"int32 a{each}" for each in range(4_001)), "Foo: my_msgs/msg/Foo has 4001 fields"),
    ],
)
def test_what_is_too_large_is_refused(text: str, error: str) -> None:
    with pytest.raises(DefinitionError) as raised:
        built(text)
    assert str(raised.value).startswith(error)


def chain(count: int, line: str) -> Callable[[str], Any]:
    """Types A0 to A(count), each of which contains the next by `line`."""

    def resolve(name: str) -> Any:
        index = int(name.rpartition("A")[2])
        text = line.replace("NEXT", f"A{index + 1}") if index < count else "int32 x"
        return build(parse(text, name), resolve)

    return resolve


def test_the_deepest_type_that_is_taken_has_a_codec() -> None:
    deepest = chain(16, "NEXT[] x")("m/msg/A0")
    assert decode(deepest, encode(deepest())) == deepest()
    with pytest.raises(DefinitionError, match=r"messages within messages 18 deep, sequences of them 17 deep"):
        chain(17, "NEXT[] x")("m/msg/A0")
    deepest = chain(47, "NEXT x")("m/msg/A0")
    assert weight(deepest).depth == 48
    assert decode(deepest, encode(deepest())) == deepest()
    with pytest.raises(DefinitionError, match="49 deep"):
        chain(48, "NEXT x")("m/msg/A0")


def test_types_that_grow_by_doubling_are_refused() -> None:
    known: dict[str, Any] = {"m/msg/A40": built("int32 x", "m/msg/A40")}

    def double(index: int) -> None:
        name = f"m/msg/A{index}"
        known[name] = build(parse(f"A{index + 1} x\nA{index + 1} y", name), known.__getitem__)

    for index in range(39, 28, -1):
        double(index)
    with pytest.raises(DefinitionError, match="m/msg/A28 has 4096 fields with those of its messages; at most 4000"):
        double(28)


# Of Python classes.


@pytest.mark.parametrize("name", ["_x", "Units", "\u00fcnits", "a__b", "x_", "a" * 256])
def test_a_python_class_has_fields_that_ros_can_name(name: str) -> None:
    with pytest.raises(MessageError, match=r"my_msgs/msg/Foo: .* (not a field name|characters long)"):
        MessageMeta("Foo", (Message,), {**BODY, "__annotations__": {name: float64}}, type_name="my_msgs/msg/Foo")


BODY = {"__module__": __name__, "__qualname__": "Foo"}


def test_a_python_class_has_constants_that_ros_can_name() -> None:
    with pytest.raises(MessageError, match="'left' is not a constant name: A-Z"):

        class Wrong(Message):
            left: ClassVar[uint8] = 1

    with pytest.raises(MessageError, match="the constant LEFT has no value"):

        class Without(Message):
            LEFT: ClassVar[uint8]


def test_a_python_class_cannot_extend_another() -> None:
    with pytest.raises(MessageError, match=r"a message cannot extend another .Twist.: make it a field"):

        class Faster(Twist):
            factor: float32


def test_a_class_that_extends_another_takes_fields_of_any_name() -> None:
    class Status(DiagnosticStatus):
        """A message with a method."""

    made = Status(message="fine", name="motor")
    assert (made.message, made.name) == ("fine", "motor")


@pytest.mark.parametrize(
    ("module", "package"),
    [
        ("wheels", "wheels"),
        ("my_nodes.wheels", "wheels"),
        ("/home/me/My-Wheels 2.py", "my_wheels_2"),
        ("2nd_try", "node_2nd_try"),
        ("_a__b_", "a_b"),
        ("größe", "gr_e"),
        ("轮", "node"),
        ("my_msgs.msg", "my_msgs"),
    ],
)
def test_the_package_of_a_python_class_is_one_that_ros_can_name(module: str, package: str) -> None:
    made: Any = MessageMeta("Foo", (Message,), {"__module__": module, "__qualname__": "Foo"})
    assert made.__ros_type__ == f"{package}/msg/Foo"


X = field("x", 6)
