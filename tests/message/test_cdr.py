"""The codec: its bytes are those of rosbags, both ways, and whatever is wrong raises one clear error."""

import random
import struct
from typing import Annotated, Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from robolink.exceptions import DecodeError, EncodeError
from robolink.interfaces import find, names
from robolink.interfaces.action_msgs.srv import CancelGoal
from robolink.interfaces.example_interfaces.msg import WString
from robolink.interfaces.std_msgs.msg import Empty, String
from robolink.message import (
    AtMost,
    FieldType,
    Message,
    Sequence,
    Size,
    boolean,
    buffers_encoder,
    byte,
    char,
    decode,
    encode,
    float32,
    float64,
    from_builtins,
    int8,
    int16,
    int32,
    int64,
    string,
    type_name,
    uint8,
    uint16,
    uint32,
    uint64,
    wstring,
)
from tests.support.filled import filled
from tests.support.ros_test_types import msg as ros

RELAXED = settings(deadline=None, suppress_health_check=list(HealthCheck))


class Inner(Message):
    """Ends where nothing is aligned, begins with what needs most of it."""

    wide: float64
    nothing: Empty
    text: string
    small: int8


class Everything(Message):
    """Every primitive, alone and in every kind of sequence, in an order that needs padding everywhere."""

    a: bool
    b: float64
    c: byte
    d: int16
    e: char
    f: uint64
    g: string
    h: uint16
    i: int64
    j: uint8
    k: float32
    bools: Sequence[boolean]
    doubles: Sequence[float64]
    octets: Sequence[byte]
    longs: Sequence[int64]
    shorts: Sequence[uint16]
    words: Sequence[string]
    three_bools: Annotated[Sequence[boolean], Size(3)]
    two_doubles: Annotated[Sequence[float64], Size(2)]
    two_octets: Annotated[Sequence[byte], Size(2)]
    three_chars: Annotated[Sequence[char], Size(3)]
    two_words: Annotated[Sequence[string], Size(2)]
    inner: Inner
    inners: Sequence[Inner]
    two_inners: Annotated[Sequence[Inner], Size(2)]
    few_inners: Annotated[Sequence[Inner], AtMost(2)]
    few_floats: Annotated[Sequence[float32], AtMost(3)]
    few_words: Annotated[Sequence[string], AtMost(2)]
    short_word: Annotated[string, AtMost(4)]
    nothings: Sequence[Empty]
    last: uint32


class Wide(Message):
    """Text in UTF-16 between numbers."""

    before: uint8
    text: wstring
    texts: Sequence[wstring]
    after: uint8


class Fixed(Message):
    """Only numbers: packed in one call."""

    a: int8
    b: int32
    c: bool
    d: float64
    e: uint64
    f: uint32


def classes() -> list[Any]:
    """Every message class there is: standard messages, the parts of services and actions, and the rich ones above.

    Those with wide text are left out: rosbags has none.
    """
    actions: list[Any] = [find(name, "action") for name in names("action")]
    services: list[Any] = [find(name, "srv") for name in names("srv")]
    services += [service for each in actions for service in (each.Impl.SendGoalService, each.Impl.GetResultService)]
    parts = [part for each in services for part in (each.Request, each.Response)]
    parts += [CancelGoal.Event]  # one for all: they hold nothing but requests and responses
    parts += [part for each in actions for part in (each.Goal, each.Result, each.Feedback, each.Impl.FeedbackMessage)]
    every = [*(find(name) for name in names("msg")), *parts, Inner, Everything, Fixed]
    return [cls for cls in every if all(kind.base != "wstring" for kind in cls.__ros_fields__.values())]


CLASSES = classes()

# ---- values of any type --------------------------------------------------------------------------------------------

LIMITS = {f"{sign}int{bits}": (bits, sign) for bits in (8, 16, 32, 64) for sign in ("", "u")}


def elements(kind: FieldType) -> st.SearchStrategy[Any]:
    if kind.message is not None:
        return messages(kind.message)
    if kind.base in LIMITS:
        bits, sign = LIMITS[kind.base]
        return st.integers(0, 2**bits - 1) if sign else st.integers(-(2 ** (bits - 1)), 2 ** (bits - 1) - 1)
    most = kind.string_bound or 6
    simple: dict[str, st.SearchStrategy[Any]] = {
        "bool": st.booleans(),
        "byte": st.binary(min_size=1, max_size=1),
        "char": st.integers(0, 255),
        "float32": st.floats(width=32, allow_nan=False),
        "float64": st.floats(allow_nan=False),
        "string": st.text(st.characters(exclude_characters="\0", exclude_categories=["Cs"]), max_size=most),
        "wstring": st.text(max_size=most),
    }
    return simple[kind.base]


def values(kind: FieldType) -> st.SearchStrategy[Any]:
    if kind.shape == "one":
        return elements(kind)
    least, most = (kind.size, kind.size) if kind.shape == "array" else (0, min(kind.size or 3, 3))
    return st.lists(elements(kind), min_size=least, max_size=most)


def messages(cls: Any) -> st.SearchStrategy[Any]:
    return st.builds(cls, **{name: values(kind) for name, kind in cls.__ros_fields__.items()})


# ---- rosbags, the oracle -------------------------------------------------------------------------------------------

STORE = get_typestore(Stores.ROS2_JAZZY)


def oracle_name(cls: Any) -> str:
    """The name by which rosbags knows the type; types that it has not are registered from their .msg text."""
    name = type_name(cls).replace("/srv/", "/msg/").replace("/action/", "/msg/")
    if name not in STORE.types:
        for kind in cls.__ros_fields__.values():
            if kind.message is not None:
                oracle_name(kind.message)
        lines = [f"{kind} {field}" for field, kind in cls.__ros_fields__.items()]
        text = "\n".join(lines or ["uint8 structure_needs_at_least_one_member"])
        STORE.register(get_types_from_msg(text.replace("/srv/", "/").replace("/action/", "/"), name))
    return name


def to_oracle(message: Any) -> Any:
    fields = message.__ros_fields__
    made = STORE.types[oracle_name(type(message))]
    arguments = [to_oracle_value(kind, getattr(message, name)) for name, kind in fields.items()]
    return made(*arguments or ([] if type(message) is Empty else [0]))


def to_oracle_value(kind: FieldType, value: Any) -> Any:
    if kind.shape != "one" and kind.message is None and kind.base != "string":
        plain = [each[0] for each in value] if kind.base == "byte" else list(value)
        return np.array(plain, {"byte": "uint8", "char": "uint8"}.get(kind.base, kind.base))
    if kind.shape != "one":
        return [to_oracle(each) if kind.message is not None else each for each in value]
    if kind.message is not None:
        return to_oracle(value)
    return int.from_bytes(value, "little", signed=True) if kind.base == "byte" else value  # theirs has a sign


def oracle_bytes(message: Any, little_endian: bool = True) -> bytes:
    return bytes(STORE.serialize_cdr(to_oracle(message), oracle_name(type(message)), little_endian=little_endian))


def check_against_the_oracle(message: Any) -> None:
    data = encode(message)
    cls = type(message)
    assert data == oracle_bytes(message), type_name(cls)
    assert b"".join(buffers_encoder(cls)(message)) == data, type_name(cls)
    assert decode(cls, data) == message
    assert decode(cls, oracle_bytes(message, little_endian=False)) == message
    theirs = STORE.deserialize_cdr(data, oracle_name(cls))
    assert bytes(STORE.serialize_cdr(theirs, oracle_name(cls))) == data, type_name(cls)


@pytest.mark.slow
def test_every_type_agrees_with_rosbags() -> None:
    for cls in CLASSES:
        dice = random.Random(type_name(cls))
        for message in (decode(cls, encode(cls())), filled(cls, dice)):  # a default such as 0.3 is no float32
            check_against_the_oracle(message)


@pytest.mark.slow
@given(message=messages(Everything))
@settings(RELAXED, max_examples=50)
def test_everything_agrees_with_rosbags(message: Everything) -> None:
    check_against_the_oracle(message)


@pytest.mark.slow
@given(arrays=messages(ros.Arrays), bounded=messages(ros.BoundedSequences), unbounded=messages(ros.UnboundedSequences))
@settings(RELAXED, max_examples=10)
def test_sequences_of_sequences_agree_with_rosbags(arrays: Any, bounded: Any, unbounded: Any) -> None:
    check_against_the_oracle(
        ros.MultiNested(
            array_of_arrays=[arrays, ros.Arrays(), arrays],
            array_of_bounded_sequences=[bounded] * 3,
            array_of_unbounded_sequences=[unbounded] * 3,
            bounded_sequence_of_arrays=[arrays],
            bounded_sequence_of_bounded_sequences=[bounded, ros.BoundedSequences()],
            unbounded_sequence_of_arrays=[arrays, arrays],
            unbounded_sequence_of_unbounded_sequences=[ros.UnboundedSequences(), unbounded],
        )
    )


# ---- wide text, which rosbags has not ------------------------------------------------------------------------------


def test_wide_text_is_a_count_and_four_bytes_for_each_utf16_unit() -> None:
    message = Wide(before=1, text="a\U0001f916", texts=["é"], after=2)
    numbers = (3, 0x61, 0xD83E, 0xDD16, 1, 1, 0xE9)  # the robot takes two units
    little = b"\x01\0\0\0" + struct.pack("<7I", *numbers) + b"\x02"
    big = b"\x01\0\0\0" + struct.pack(">7I", *numbers) + b"\x02"
    assert encode(message) == b"\x00\x01\x00\x00" + little
    assert decode(Wide, b"\x00\x00\x00\x00" + big) == message


@given(message=messages(Wide))
@RELAXED
def test_wide_text_comes_back(message: Wide) -> None:
    assert decode(Wide, encode(message)) == message


@given(message=messages(ros.WStrings))
@RELAXED
def test_wide_strings_in_every_kind_of_sequence_come_back(message: Any) -> None:
    assert decode(ros.WStrings, encode(message)) == message


def test_a_wide_character_beyond_16_bits_is_refused_as_in_ros() -> None:
    data = encode(WString(data="a")).replace(b"a\0\0\0", b"\0\0\1\0")
    with pytest.raises(DecodeError, match="example_interfaces/msg/WString: a wide character beyond 16 bits"):
        decode(WString, data)


class ShortWide(Message):
    text: Annotated[wstring, AtMost(3)]


class Short(Message):
    text: Annotated[string, AtMost(3)]


@pytest.mark.parametrize("cls", [Short, ShortWide])
def test_a_bound_of_text_counts_characters_as_rclpy_does(cls: Any) -> None:
    robots = "\U0001f916\U0001f916\U0001f916"
    assert decode(cls, encode(cls(text=robots))).text == robots
    assert from_builtins(cls, {"text": robots}).text == robots
    with pytest.raises(EncodeError, match=rf"{cls.__name__}.text: expected at most 3 characters, got 4"):
        encode(cls(text="four"))


def test_text_over_its_bound_is_read_as_ros_reads_it() -> None:
    assert decode(Short, encode(String(data="four"))).text == "four"
    assert decode(ShortWide, encode(WString(data="four"))).text == "four"


@pytest.mark.parametrize(
    ("count", "body", "text"),
    [
        (2, b"ab", "ab"),  # the final NUL is missing
        (6, b"a\0bcd\0", "a"),
        (4, b"a\0\0\0", "a"),
        (3, b"\0b\0", ""),
        (4, b"a\0bc", "a"),
        (4, b"\xffa\0b", "\ufffda"),
        (0, b"", ""),
    ],
)
def test_a_nul_ends_a_text_that_arrives(count: int, body: bytes, text: str) -> None:
    assert decode(String, b"\0\1\0\0" + struct.pack("<I", count) + body).data == text


def test_a_nul_ends_a_text_that_is_sent() -> None:
    assert encode(String(data="a\0b")) == encode(String(data="a"))
    assert encode(Short(text="a\0b")) == encode(Short(text="a"))
    assert decode(ShortWide, encode(ShortWide(text="a\0b"))).text == "a\0b"  # wide text has no NUL at its end
