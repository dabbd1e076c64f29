"""The reader of .msg, .srv and .action files: what rosidl takes is read, all else is refused with its place."""

import math
import re
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.exceptions import DefinitionError, MessageError
from robolink.message import FieldType, literals
from robolink.message.definition import Definition, field_type, parse


def message(text: str) -> Any:
    (section,) = parse(text, "my_msgs/msg/Foo").sections
    return section


@pytest.mark.parametrize(
    ("text", "kind"),
    [
        ("bool", FieldType("bool")),
        ("byte[]", FieldType("byte", shape="sequence")),
        ("char[3]", FieldType("char", shape="array", size=3)),
        ("float64[<=3]", FieldType("float64", shape="bounded", size=3)),
        ("string<=5", FieldType("string", string_bound=5)),
        ("wstring<=5[]", FieldType("wstring", string_bound=5, shape="sequence")),
        ("string<=5[<=3]", FieldType("string", string_bound=5, shape="bounded", size=3)),
        ("string<=5[2]", FieldType("string", string_bound=5, shape="array", size=2)),
        ("Point", FieldType("my_msgs/msg/Point")),
        ("Header", FieldType("my_msgs/msg/Header")),
        ("geometry_msgs/Point[2]", FieldType("geometry_msgs/msg/Point", shape="array", size=2)),
        ("geometry_msgs/msg/Point", FieldType("geometry_msgs/msg/Point")),
        ("std_srvs/srv/SetBool_Request[<=1]", FieldType("std_srvs/srv/SetBool_Request", shape="bounded", size=1)),
    ],
)
def test_types(text: str, kind: FieldType) -> None:
    assert field_type(text, "my_msgs") == kind
    (field,) = message(f"{text} x").fields
    assert (field.type, field.name, field.default) == (kind, "x", None)


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("bool x true", True),
        ("bool x False", False),
        ("bool x 1", True),
        ("byte x 0xff", 255),
        ("char x 65", 65),
        ("int8 x -128", -128),
        ("int8 x +5", 5),
        ("uint8 x 007", 7),
        ("uint16 x 0o17", 15),
        ("uint16 x 0b1_01", 5),
        ("int32 x 1_000", 1000),
        ("uint64 x 0xFFFF_FFFF_FFFF_FFFF", 2**64 - 1),
        ("int64 x\t-9223372036854775808", -(2**63)),
        ("float32 x .5", 0.5),
        ("float64 x 1", 1.0),
        ("float64 x -1.e-3", -0.001),
        ("float64 x inf", math.inf),
        ("string x", None),
        ("string x plain words  # not these", "plain words"),
        ("string x it's # a comment", "it's"),
        ('string x "  kept  "', "  kept  "),
        ("string x 'single'", "single"),
        ('string x "a#b" # c', "a#b"),
        ('string x "a=b"', "a=b"),
        ('string x ""', ""),
        (r'string x "say \"hi\""', 'say "hi"'),
        (r"string x 'it\'s'", "it's"),
        (r'string x "\ttab\n\x41\101\u00e9\\"', "\ttab\nAAé\\"),
        (r"string x \d", r"\d"),
        ('string x "unclosed', '"unclosed'),
        ("string<=4 x four", "four"),
        ("wstring<=2 x 'éé'", "éé"),
        ("int32[] x []", []),
        ("int32[] x [1, -2 ,0x3]  # three", [1, -2, 3]),
        ("bool[2] x [true, 0]", [True, False]),
        ("float64[<=3] x [1, .5]", [1.0, 0.5]),
        ("byte[] x [1,255]", [1, 255]),
        ("""string[] x ["a, b", 'c#]', d e, "f"]""", ["a, b", "c#]", "d e", "f"]),
        ("string<=3[<=2] x [abc, 'd']", ["abc", "d"]),
    ],
)
def test_defaults(text: str, value: Any) -> None:
    (field,) = message(text).fields
    assert field.default == value
    assert type(field.default) is type(value)


@pytest.mark.parametrize(
    ("text", "name", "value"),
    [
        ("uint8 X=1", "X", 1),
        ("uint8 X = 0x10 # sixteen", "X", 16),
        ("int8 LEFT_2=-3", "LEFT_2", -3),
        ("float32 PI= 3.14", "PI", 3.14),
        ("bool ON =true", "ON", True),
        ("string NAME=some words", "NAME", "some words"),
        ('string NAME="a = b # c"', "NAME", "a = b # c"),
        ("string NAME=", "NAME", ""),
        ("byte B=7", "B", 7),
        ("char C=7", "C", 7),
        ("wstring W='ß'", "W", "ß"),
    ],
)
def test_constants(text: str, name: str, value: Any) -> None:
    section = message(text)
    (constant,) = section.constants
    assert (constant.name, constant.value, constant.type.base) == (name, value, text.split()[0])
    assert section.fields == ()


COMMENTED = """\
# Two lines of
#   head.
# All of it.

# Above the speed.

# Still above.
float64 speed 0.5  # [m/s] behind
                   # and below
uint8 LEFT=1 # left
# At the end, beside nothing.
"""


def test_comments_are_kept_with_what_they_stand_beside() -> None:
    section = message(COMMENTED)
    assert section.comment == ("Two lines of", "  head.", "All of it.")
    (speed,) = section.fields
    assert speed.above == ("Above the speed.", "Still above.")
    assert speed.behind == "[m/s] behind\nand below"
    assert (speed.line, speed.column) == (8, 1)
    (left,) = section.constants
    assert (left.above, left.behind, left.line) == ((), "left", 10)
    assert section.text == COMMENTED


def test_comments_after_an_empty_line_are_the_first_fields() -> None:
    section = message("\n# When.\nfloat64 time\n")
    assert (section.comment, section.fields[0].above) == ((), ("When.",))


def test_services_and_actions_have_sections() -> None:
    service = parse("# Asks.\nint32 a\n---\n# Answers.\nint32 b\n", "my_msgs/srv/Add")
    assert [(each.type_name, each.comment) for each in service.sections] == [
        ("my_msgs/srv/Add_Request", ("Asks.",)),
        ("my_msgs/srv/Add_Response", ("Answers.",)),
    ]
    assert service.sections[1].fields[0].line == 5
    action = parse("---\n---", "my_msgs/action/Do")
    assert [each.type_name.rpartition("_")[2] for each in action.sections] == ["Goal", "Result", "Feedback"]
    assert [each.fields for each in action.sections] == [(), (), ()]


def test_the_part_of_a_service_is_a_message() -> None:
    (section,) = parse("bool data", "std_srvs/srv/SetBool_Request").sections
    assert section.type_name == "std_srvs/srv/SetBool_Request"


def test_windows_files_are_read() -> None:
    section = message("\ufeff# Head.\r\n\r\nint32 a\r\nint32 b\r\n")
    assert section.comment == ("Head.",)
    assert [(each.name, each.line) for each in section.fields] == [("a", 3), ("b", 4)]


BAD = [
    ("int32", "1:1: 'int32' alone is not a field: write a type and a name"),
    ("\n  int32 # x", "2:3: 'int32' alone is not a field: write a type and a name"),
    ("int32=5", "1:1: 'int32=5' alone is not a field: write a type and a name"),
    ("int23 x", "1:1: 'int23' is not a type (did you mean 'int32'?)"),
    ("double x", "1:1: 'double' is not a type (did you mean 'float64'?)"),
    ("time x", "1:1: 'time' is not a type (did you mean 'builtin_interfaces/Time'?)"),
    ("@optional int32 x", "1:1: '@optional': annotations belong to .idl files"),
    ("a/b/c/D x", "1:1: 'a/b/c/D' is not a full type name; it should look like my_msgs/msg/WheelSpeeds"),
    ("std_srvs/srv/SetBool x", "1:1: 'std_srvs/srv/SetBool' is not a message type: only messages can be fields"),
    ("My_msgs/Point x", "1:1: 'My_msgs' is not a package name: a-z, digits and single underscores"),
    ("my_msgs/point x", "1:1: 'point' is not a type name: CamelCase of A-Z, a-z and digits, as in WheelSpeeds"),
    ("Foo x", "1:1: my_msgs/msg/Foo cannot contain itself"),
    ("my_msgs/Foo[] x", "1:1: my_msgs/msg/Foo cannot contain itself"),
    ("int32[<= 3] x", "1:1: 'int32[<=' is not a type: write float64, float64[], float64[3], float64[<=3] ..."),
    ("int32[] [] x", "1:9: '[]' is not a field name"),
    ("int32[0] x", "1:1: 'int32[0]': a size or bound is a whole number from 1 to 4294967295"),
    ("int32[-1] x", "1:1: 'int32[-1]': a size or bound is"),
    ("int32[<=] x", "1:1: 'int32[<=]': a size or bound is"),
    ("int32[99999999999] x", "1:1: 'int32[99999999999]': a size or bound is"),
    ("int32[2][2] x", "1:1: 'int32[2][2]' is not a type"),
    ("string<=0 x", "1:1: 'string<=0': a size or bound is"),
    ("string<5 x", "1:1: 'string<5' is not a type"),
    ("int32<=5 x", "1:1: 'int32<=5': only string and wstring can be bounded so"),
    ("int32 Speed", "1:7: 'Speed' is not a field name: a-z, digits and single underscores"),
    ("int32 _x", "1:7: '_x' is not a field name"),
    ("int32 a__b", "1:7: 'a__b' is not a field name"),
    ("int32 x_", "1:7: 'x_' is not a field name"),
    ("int32 2x", "1:7: '2x' is not a field name"),
    ("int32 größe", "1:7: 'größe' is not a field name"),
    ("int32 x;", "1:7: 'x;' is not a field name"),
    ("int32 " + "x" * 256, f"1:7: '{'x' * 97}...' is 256 characters long; a name has at most 255"),
    ("int32 a\nint32 b\n int32  a", "3:9: a second 'a': the first stands in line 1"),
    ("uint8 A=1\nuint8 A=1", "2:7: a second 'A': the first stands in line 1"),
    ("uint8 speed=1", "1:7: 'speed' is not a constant name: A-Z, digits and single underscores"),
    ("uint8 A__B=1", "1:7: 'A__B' is not a constant name"),
    ("uint8[] A=[1]", "1:1: a constant of type uint8[]: only primitive types have any"),
    ("string<=5 A=a", "1:1: a constant of type string<=5: only primitive types have any"),
    ("Point A=1", "1:1: a constant of type Point: only primitive types have any"),
    ("uint8 A=", "1:9: '' is not a uint8: write a whole number such as 10, -3 or 0x1F"),
    ("uint8 A = 256", "1:11: 256 does not fit uint8: it takes 0 to 255"),
    ("uint8 x -1", "1:9: -1 does not fit uint8: it takes 0 to 255"),
    ("int8 x 128", "1:8: 128 does not fit int8: it takes -128 to 127"),
    ("byte x 256", "1:8: 256 does not fit byte: it takes 0 to 255"),
    ("int64 x 9223372036854775808", "1:9: 9223372036854775808 does not fit int64"),
    ("int32 x 1.5", "1:9: '1.5' is not an int32: write a whole number"),
    ("int32 x ٣", "1:9: '٣' is not an int32"),
    ("int32 x " + "9" * 5000, f"1:9: '{'9' * 97}...' is not an int32"),
    ("bool x yes", "1:8: 'yes' is not a bool: write true or false"),
    ("float64 x 1,5", "1:11: '1,5' is not a float64: write a number such as 0.5 or 1e-3"),
    ("float64 x 1e999", "1:11: 1e999 is too large for float64"),
    ("float32 x 1e39", "1:11: 1e+39 does not fit float32: its largest number is 3.4028235e38"),
    ('string x "a"b"', '1:10: "a"b" has a " within: write \\"'),
    ("string<=3 x four", "1:13: 'four' has 4 characters; string<=3 takes 3"),
    ("wstring<=1 x ab", "1:14: 'ab' has 2 characters; wstring<=1 takes 1"),
    (r"string x \ud800", r"1:10: '\ud800' is not valid Unicode"),
    ("Point x 1", "1:9: my_msgs/Point can have no default: only primitive types and arrays of them can"),
    ("int32[] x 1", "1:11: '1' is not an array: write [1, 2]"),
    ("int32[] x [1, 2", "1:11: '[1, 2' is not an array: write [1, 2]"),
    ("int32[] x [1, a]", "1:11: element 1: 'a' is not an int32"),
    ("int32[] x [1, , 2]", "1:11: element 1: ', 2' is not an int32"),
    ("int32[2] x [1]", "1:12: 1 elements, not the 2 of int32[2]"),
    ("int32[<=2] x [1, 2, 3]", "1:14: 3 elements, more than int32[<=2] takes"),
    ("uint8[] x [1, 300]", "1:11: element 1: 300 does not fit uint8"),
    ("---", "1:1: one '---' too many: a .msg file has 0"),
    ("int32 a\0", "1:8: a NUL character: this is not a text file"),
    ("# \ud800", "1:3: half a character ('\\ud800'): this is not a text file"),
    ("int32 a\n#" + "x" * 1_000_000, "2:1: a line of 1000001 characters (at most 65536)"),
    ("\n" * 4_000_001, "1:1: 4000001 characters are too many for an interface file (at most 4000000)"),
]


@pytest.mark.parametrize(("text", "error"), BAD, ids=[error[:40] for _, error in BAD])
def test_bad_text_is_refused_with_its_place(text: str, error: str) -> None:
    with pytest.raises(DefinitionError) as raised:
        parse(text, "my_msgs/msg/Foo", "Foo.msg")
    assert str(raised.value).startswith(f"Foo.msg:{error}")
    assert "\n" not in str(raised.value)
    assert len(str(raised.value)) < 300


@pytest.mark.parametrize(
    ("type_name", "text", "error"),
    [
        ("a/srv/B", "int32 a\n", "x:2:1: the file ends without a line '---' before the response"),
        ("a/srv/B", "---\n---", "x:2:1: one '---' too many: a .srv file has 1"),
        ("a/action/B", "---", "x:1:1: the file ends without a line '---' before the feedback"),
        ("a/action/B", "---\n---\n---", "x:3:1: one '---' too many: a .action file has 2"),
        ("a/srv/B", "---\nint32 A", "x:2:7: 'A' is not a field name"),
        ("a/srv/B", "----", "x:1:1: the file ends without a line '---' before the response"),
        ("a/srv/B", "----\n---", "x:1:1: '----' alone is not a field"),
        ("a/msg/b", "", "x: 'b' is not a type name: CamelCase of A-Z, a-z and digits, as in WheelSpeeds"),
        ("a/msg/B_Request", "", "x: 'B_Request' is not a type name"),
        ("A/msg/B", "", "x: 'A' is not a package name"),
        ("a/foo/B", "", "x: 'a/foo/B' is not a full type name; it should look like my_msgs/msg/WheelSpeeds"),
        ("B", "", "x: 'B' is not a full type name"),
        ("a/msg/../../etc\n", "", "x: 'a/msg/../../etc\\n' is not a full type name"),
    ],
)
def test_bad_files_are_refused(type_name: str, text: str, error: str) -> None:
    with pytest.raises(DefinitionError) as raised:
        parse(text, type_name, "x")
    assert str(raised.value).startswith(error)
    assert isinstance(raised.value, (MessageError, ValueError))


FIXED = """int32 uint8 string wstring<=3 bool float32[] string[2] x y X A_B = # ' " [ ] , \\ --- <= 5 -1 0x1 1e9 true
Header geometry_msgs/Point / @ é \ufeff"""
WORDS = st.sampled_from([*FIXED.split(), " ", "\n", "\t", "\r\n"])


@given(
    st.one_of(st.text(), st.lists(WORDS).map(" ".join), st.lists(WORDS).map("".join)),
    st.sampled_from(["a/msg/B", "a/srv/B", "a/action/B"]),
)
def test_any_text_is_read_or_refused(text: str, type_name: str) -> None:
    refused = ""
    try:
        assert isinstance(parse(text, type_name), Definition)
    except DefinitionError as error:
        refused = str(error)
    assert not refused or re.match("<text>:[0-9]+:[0-9]+: ", refused)


@given(st.sampled_from([field_type(each, "a") for each in ("string", "wstring", "string[]", "string[2]")]), st.data())
def test_any_string_survives_being_written(kind: FieldType, data: st.DataObject) -> None:
    one = st.text(st.characters(codec="utf-8"))
    value = data.draw(one if kind.shape == "one" else st.lists(one, min_size=2, max_size=2))
    text = literals.write(kind, value)
    assert literals.read(kind, text) == value
    assert text.isprintable()
    assert "#" not in text
    (field,) = message(f"{kind} x {text} # behind").fields
    assert (field.default, field.behind) == (value, "behind")
    assert literals.as_rosidl_said(kind, literals.as_rosidl_says(kind, value)) == value


def test_long_lines_of_elements_are_read_at_once() -> None:
    (field,) = message(f"int8[] x [{','.join(['1' + ' ' * 3] * 10_000)}]").fields
    assert len(field.default) == 10_000
    (field,) = message(f"string[] x [a{' ' * 60_000}b]").fields
    assert len(field.default[0]) == 60_002
