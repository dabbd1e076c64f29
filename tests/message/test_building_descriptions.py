"""Classes built at run time from type descriptions are the classes that Python code would have made."""

import random
from collections.abc import Iterator
from typing import Any

import msgspec
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robolink.exceptions import MessageError, NotFoundError
from robolink.interfaces import find, names
from robolink.interfaces.builtin_interfaces.msg import Time
from robolink.interfaces.geometry_msgs.msg import Point, Quaternion, Twist
from robolink.interfaces.std_msgs.msg import Empty, Header
from robolink.interfaces.std_srvs.srv import SetBool
from robolink.message import (
    Service,
    decode,
    encode,
    type_hash,
)
from robolink.message.building import checked_class, class_of_description
from robolink.message.description import (
    PLACEHOLDER,
    FieldDescription,
    TypeDescription,
    described,
    from_message,
    hash_of,
    to_message,
)
from tests.support.built_types import built, field, find_full, named, of
from tests.support.filled import filled

STANDARD = [find_full(name) for kind in ("msg", "srv", "action") for name in names(kind)]


def messages_of(cls: Any) -> list[Any]:
    if hasattr(cls, "__ros_fields__"):
        return [cls]
    return [getattr(cls, part) for part in ("Request", "Response", "Goal", "Result", "Feedback") if hasattr(cls, part)]


@pytest.mark.slow
def test_every_standard_type_is_built_of_its_description() -> None:
    for cls in STANDARD:
        is_built_of_its_description(cls)


def is_built_of_its_description(cls: Any) -> None:
    message: Any = to_message(described(cls))
    received = from_message(decode(type(message), encode(message)))
    made = checked_class(received, type_hash(cls))
    assert described(made) == described(cls)
    assert made.__ros_type__ == cls.__ros_type__
    for ours, theirs in zip(messages_of(cls), messages_of(made), strict=True):
        assert encode(theirs()) == encode(ours())
        data = encode(filled(ours, random.Random(cls.__ros_type__)))
        assert encode(decode(theirs, data)) == data


@pytest.mark.parametrize(
    "part", [SetBool.Request, SetBool.Event, find("example_interfaces/Fibonacci", "action").Impl.SendGoalService]
)
def test_the_parts_of_services_and_actions_are_types(part: Any) -> None:
    made = class_of_description(described(part))
    assert issubclass(made, Service) == issubclass(part, Service)
    assert type_hash(made) == type_hash(part)


def test_known_classes_are_used_where_they_are_the_same() -> None:
    made = class_of_description(described(Twist), find_full)
    assert made is not Twist
    assert type(made().linear) is type(Twist().linear)
    assert type(class_of_description(described(Twist))().linear) is not type(Twist().linear)
    another = built("float64 x", "geometry_msgs/msg/Vector3")
    other_linear = class_of_description(described(Twist), lambda _: another)
    assert type_hash(other_linear) == type_hash(Twist)


def test_defaults_come_along() -> None:
    assert class_of_description(described(Quaternion))().w == 1.0
    foo = built(
        "string s \"it's, a\"\nbool b true\nbyte[] o [1]\nfloat32[2] f [1, .5]\nwstring[] w ['a, b', '\"']\nint8 e"
    )
    fields = described(foo).fields
    assert [each.default_value for each in fields] == [
        "it's, a",
        "True",
        "(1,)",
        "(1.0, 0.5)",
        "('a, b', '\"')",
        "",
    ]
    assert encode(class_of_description(described(foo))()) == encode(foo())


def test_defaults_that_do_not_fit_are_left_out() -> None:
    fields = [
        field("a", 6, default_value="x"),
        field("b", 150, default_value="(1, x)"),
        field("c", 3, default_value="-1"),
    ]
    made: Any = class_of_description(TypeDescription("a/msg/B", tuple(fields)))
    assert (made().a, list(made().b), made().c) == (0, [], 0)


def test_an_empty_message() -> None:
    made = class_of_description(described(Empty))
    assert made.__ros_fields__ == {}
    assert encode(made()) == encode(Empty())


def test_a_hash_that_is_not_the_expected_one() -> None:
    wrong = type_hash(Twist)
    with pytest.raises(MessageError) as raised:
        checked_class(described(Point), wrong)
    assert str(raised.value) == (
        f"the description of geometry_msgs/msg/Point has the hash {type_hash(Point)}, not {wrong}"
    )


X = field("x", 6)


def replaced(cls: Any, **changes: Any) -> TypeDescription:
    return msgspec.structs.replace(described(cls), **changes)


def with_wrong_sum() -> TypeDescription:
    whole = described(SetBool)
    referenced = [
        msgspec.structs.replace(each, fields=(X,)) if each.type_name.endswith("ServiceEventInfo") else each
        for each in whole.referenced
    ]
    return msgspec.structs.replace(whole, referenced=tuple(referenced))


WRONG = [
    (of(field("x", 0)), "a/msg/B.x: there is no type id 0"),
    (of(field("x", 12)), "a/msg/B.x: long double is not supported"),
    (of(field("x", 13)), "a/msg/B.x: IDL char is not supported"),
    (of(field("x", 62)), "a/msg/B.x: wchar is not supported"),
    (of(field("x", 19, 0, 5)), "a/msg/B.x: fixed string is not supported"),
    (of(field("x", 23)), "a/msg/B.x: there is no type id 23"),
    (of(field("x", 48)), "a/msg/B.x: there is no type id 48"),
    (of(field("x", 255)), "a/msg/B.x: there is no type id 255"),
    (of(field("x", -3)), "a/msg/B.x: there is no type id -3"),
    (of(field("x", 6, 3)), "a/msg/B.x: type id 6 with a size of 3"),
    (of(field("x", 6, 0, 3)), "a/msg/B.x: type id 6 with a string bound of 3"),
    (of(field("x", 54)), "a/msg/B.x: type id 54 with a size of 0"),
    (of(field("x", 54, 2**40)), "a/msg/B.x: type id 54 with a size of 1099511627776"),
    (of(field("x", 54, 2**31)), "a/msg/B has fixed arrays of 8589934"),
    (of(field("x", 21)), "a/msg/B.x: type id 21 with a string bound of 0"),
    (of(field("x", 6, 0, 0, "a/msg/C"), C=(X,)), "a/msg/B.x: type id 6 with the nested type 'a/msg/C'"),
    (of(field("x", 1)), "a/msg/B.x: type id 1 with the nested type ''"),
    (of(field("x", 1, 0, 0, "a/msg/C")), "a/msg/B refers to a/msg/C, which is not described"),
    (of(field("x", 1, 0, 0, "a/msg/B")), "a message cannot contain itself: a/msg/B -> a/msg/B"),
    (
        of(field("c", 1, 0, 0, "a/msg/C"), C=(field("d", 145, 0, 0, "a/msg/D"),), D=(field("c", 1, 0, 0, "a/msg/C"),)),
        "a message cannot contain itself: a/msg/C -> a/msg/D -> a/msg/C",
    ),
    (of(X, C=(X,)), "the description of a/msg/B contradicts itself: a/msg/C is not used"),
    (of(X, B=(X,)), "a/msg/B is described twice"),
    (
        of(field("c", 1, 0, 0, "a/msg/C"), field("d", 1, 0, 0, "a/msg/D"), D=(X,), C=(X,)),
        "the description of a/msg/B contradicts itself: types are not sorted",
    ),
    (replaced(SetBool, referenced=()), "std_srvs/srv/SetBool refers to std_srvs/srv/SetBool_Request, which is not"),
    (with_wrong_sum(), "contradicts itself: service_msgs/msg/ServiceEventInfo is not what it is elsewhere"),
    (
        replaced(SetBool, fields=described(SetBool).fields[:2]),
        "std_srvs/srv/SetBool is described as a message, which no srv type is",
    ),
    (of(X, X), "a/msg/B.x is described twice"),
    (of(field("__class__", 6)), "a/msg/B: '__class__' is not a field name"),
    (of(field("x = exit()", 6)), "a/msg/B: 'x = exit()' is not a field name"),
    (of(field("x\n", 6)), "a/msg/B: 'x\\n' is not a field name"),
    (of(field("", 6)), "a/msg/B: '' is not a field name"),
    (of(field("x" * 1_000_000, 6)), "' is 1000000 characters long; a name has at most 255"),
    (of(X, name="a/msg/b"), "'b' is not a type name"),
    (of(X, name="a/srv/B"), "a/srv/B is described as a message, which no srv type is"),
    (of(X, name="os.system/msg/B"), "'os.system' is not a package name"),
    (of(X, name="../msg/B"), "'..' is not a package name"),
    (of(X, name="B" * 1_000_000), "' is not a full type name"),
    (of(X, **named({"C\n": (X,)})), "'C\\n' is not a type name"),
    (of(X, name="a/msg/" + "B" * 256), "is 256 characters long"),
    (of(*(field(f"x{each}", 6) for each in range(20_001))), "a description of 20001 fields, over 20000"),
    (of(X, **named({f"C{each}": () for each in range(1_001)})), "a description that refers to 1001 types, over 1000"),
    (
        of(
            field("x", 1, nested="a/msg/C0"),
            **named({f"C{each}": (field("x", 1, nested=f"a/msg/C{each + 1}"),) for each in range(900)}),
        ),
        "a/msg/B has messages within messages over 48 deep",
    ),
]


@pytest.mark.parametrize(("description", "error"), WRONG, ids=[error[-60:] for _, error in WRONG])
def test_wrong_descriptions_are_refused(description: TypeDescription, error: str) -> None:
    with pytest.raises(MessageError) as raised:
        class_of_description(description)
    assert error in str(raised.value)
    assert len(str(raised.value)) < 400
    assert "\n" not in str(raised.value)


def test_a_resolver_that_knows_nothing_is_no_obstacle() -> None:
    def nothing(name: str) -> Any:
        raise NotFoundError("message type", name)

    assert type_hash(class_of_description(described(Header), nothing)) == type_hash(Header)
    assert type_hash(class_of_description(described(Header), lambda _: Time)) == type_hash(Header)


SHORTS = st.sampled_from(["A", "B", "C", "D_Request", "b", "", "A\n"])

TYPE_NAMES = st.one_of(
    st.builds("{}/{}/{}".format, st.sampled_from(["a", "b", "A"]), st.sampled_from(["msg", "srv", "x"]), SHORTS),
    st.builds("a/msg/{}".format, st.sampled_from("ABCD")),
    st.text(max_size=5),
)

FIELDS = st.builds(
    FieldDescription,
    st.one_of(st.sampled_from(["x", "y", "class", "m", "_x", PLACEHOLDER, "request_message"]), st.text(max_size=3)),
    st.one_of(st.sampled_from([1, 2, 3, 11, 17, 21, 49, 56, 97, 145, 160]), st.integers(0, 255)),
    st.sampled_from([0, 0, 0, 1, 3, 2**20, 2**63]),
    st.sampled_from([0, 0, 0, 1, 2**63]),
    st.one_of(st.just(""), TYPE_NAMES),
    st.one_of(st.just(""), st.sampled_from(["1", "(1,)", "('a',)", "nan", "True"]), st.text(max_size=5)),
)


def descriptions(depth: int = 1) -> st.SearchStrategy[TypeDescription]:
    fields = st.lists(FIELDS, max_size=4).map(tuple)
    if not depth:
        return st.builds(TypeDescription, TYPE_NAMES, fields)
    referenced = st.lists(descriptions(depth - 1), max_size=4).map(
        lambda each: tuple(sorted(each, key=lambda one: one.type_name))
    )
    return st.builds(TypeDescription, TYPE_NAMES, fields, referenced)


@pytest.mark.slow
@settings(max_examples=100)
@given(descriptions())
def test_any_description_makes_a_class_or_is_refused(description: TypeDescription) -> None:
    makes_its_class_or_is_refused(description)


def makes_its_class_or_is_refused(description: TypeDescription) -> None:
    try:
        made = class_of_description(description)
    except MessageError:
        return
    assert hash_of(described(made)) == hash_of(description)
    for each in messages_of(made):
        assert encode(decode(each, encode(each()))) == encode(each())


@st.composite
def falsified(draw: st.DrawFn) -> TypeDescription:
    """A real description with something changed in it, or several things."""
    types = [*(whole := described(draw(st.sampled_from(STANDARD)))).referenced, whole]
    for _ in range(draw(st.integers(1, 3))):
        index = draw(st.integers(0, len(types) - 1))
        kept = msgspec.structs.replace(types[index], referenced=())
        fields = list(kept.fields)
        place = draw(st.integers(0, len(fields) - 1))
        name = draw(st.sampled_from(FieldDescription.__struct_fields__))
        other = draw(st.sampled_from([getattr(each, name) for one in types for each in one.fields]))
        fields[place] = msgspec.structs.replace(fields[place], **{name: other})
        changed = msgspec.structs.replace(kept, fields=tuple(fields), type_name=draw(st.sampled_from(types)).type_name)
        types[index] = draw(st.sampled_from([changed, msgspec.structs.replace(kept, fields=tuple(fields))]))
        if len(types) > 1 and draw(st.integers(0, 5)) == 0:
            types.insert(draw(st.integers(0, len(types) - 2)), types.pop(0))
    return msgspec.structs.replace(types[-1], referenced=tuple(types[:-1]))


@given(falsified())
def test_what_is_nearly_right_makes_its_own_class_or_is_refused(description: TypeDescription) -> None:
    makes_its_class_or_is_refused(description)


def lines() -> Iterator[st.SearchStrategy[str]]:
    """Fields of every shape, with defaults."""
    numbers = {
        "int8": (-128, 127),
        "uint16": (0, 65535),
        "byte": (0, 255),
        "char": (0, 255),
        "int64": (-(2**63), 2**63 - 1),
    }
    for name, (low, high) in numbers.items():
        yield st.integers(low, high).map(lambda value, name=name: f"{name} NAME {value}")  # type: ignore[misc]
        yield st.lists(st.integers(low, high)).map(lambda value, name=name: f"{name}[] NAME {value}")  # type: ignore[misc]
    yield st.floats(allow_nan=False).map("float64 NAME {!r}".format)
    yield st.lists(st.booleans(), min_size=2, max_size=2).map("bool[2] NAME {}".format)
    yield st.integers(1, 9).map("string<={} NAME".format)
    yield st.integers(1, 9).map("geometry_msgs/Point[<={}] NAME".format)
    yield st.sampled_from(
        ["std_msgs/Header[2] NAME", "wstring NAME 'ß\"'", "uint8 CONST=3 # c", "float32[] NAME", "# x"]
    )


@given(st.lists(st.one_of(*lines())))
def test_texts_descriptions_and_classes_say_the_same(texts: list[str]) -> None:
    numbered = [each.replace("NAME", f"x{index}").replace("CONST", f"C{index}") for index, each in enumerate(texts)]
    made = built("\n".join(numbered))
    again = class_of_description(described(made), find_full)
    assert described(again) == described(made)
    assert encode(again()) == encode(made())
    assert encode(decode(again, encode(made()))) == encode(made())
