"""The messages of type_description_interfaces: what a type is made of, and the text that says so."""

from typing import Annotated, ClassVar

from robolink.message import AtMost, Message, Sequence, string, uint8, uint64


class FieldType(Message):
    """The type of one field: a code, and the numbers and the name that some codes need.

    Codes 1 to 48 stand for single values. The same code plus 48 is a fixed array of them, plus 96 a bounded
    sequence, plus 144 a sequence of any length. `capacity` is the length of an array, or the most elements that a
    bounded sequence takes; `string_capacity` the most characters of a bounded string; `nested_type_name`
    (``package/msg/Name``) the type of a nested message. What does not apply is 0 or empty.
    """

    FIELD_TYPE_NOT_SET: ClassVar[uint8] = 0
    FIELD_TYPE_NESTED_TYPE: ClassVar[uint8] = 1
    FIELD_TYPE_INT8: ClassVar[uint8] = 2
    FIELD_TYPE_UINT8: ClassVar[uint8] = 3
    FIELD_TYPE_INT16: ClassVar[uint8] = 4
    FIELD_TYPE_UINT16: ClassVar[uint8] = 5
    FIELD_TYPE_INT32: ClassVar[uint8] = 6
    FIELD_TYPE_UINT32: ClassVar[uint8] = 7
    FIELD_TYPE_INT64: ClassVar[uint8] = 8
    FIELD_TYPE_UINT64: ClassVar[uint8] = 9
    FIELD_TYPE_FLOAT: ClassVar[uint8] = 10
    FIELD_TYPE_DOUBLE: ClassVar[uint8] = 11
    FIELD_TYPE_LONG_DOUBLE: ClassVar[uint8] = 12
    FIELD_TYPE_CHAR: ClassVar[uint8] = 13
    FIELD_TYPE_WCHAR: ClassVar[uint8] = 14
    FIELD_TYPE_BOOLEAN: ClassVar[uint8] = 15
    FIELD_TYPE_BYTE: ClassVar[uint8] = 16
    FIELD_TYPE_STRING: ClassVar[uint8] = 17
    FIELD_TYPE_WSTRING: ClassVar[uint8] = 18
    FIELD_TYPE_FIXED_STRING: ClassVar[uint8] = 19
    FIELD_TYPE_FIXED_WSTRING: ClassVar[uint8] = 20
    FIELD_TYPE_BOUNDED_STRING: ClassVar[uint8] = 21
    FIELD_TYPE_BOUNDED_WSTRING: ClassVar[uint8] = 22
    FIELD_TYPE_NESTED_TYPE_ARRAY: ClassVar[uint8] = 49
    FIELD_TYPE_INT8_ARRAY: ClassVar[uint8] = 50
    FIELD_TYPE_UINT8_ARRAY: ClassVar[uint8] = 51
    FIELD_TYPE_INT16_ARRAY: ClassVar[uint8] = 52
    FIELD_TYPE_UINT16_ARRAY: ClassVar[uint8] = 53
    FIELD_TYPE_INT32_ARRAY: ClassVar[uint8] = 54
    FIELD_TYPE_UINT32_ARRAY: ClassVar[uint8] = 55
    FIELD_TYPE_INT64_ARRAY: ClassVar[uint8] = 56
    FIELD_TYPE_UINT64_ARRAY: ClassVar[uint8] = 57
    FIELD_TYPE_FLOAT_ARRAY: ClassVar[uint8] = 58
    FIELD_TYPE_DOUBLE_ARRAY: ClassVar[uint8] = 59
    FIELD_TYPE_LONG_DOUBLE_ARRAY: ClassVar[uint8] = 60
    FIELD_TYPE_CHAR_ARRAY: ClassVar[uint8] = 61
    FIELD_TYPE_WCHAR_ARRAY: ClassVar[uint8] = 62
    FIELD_TYPE_BOOLEAN_ARRAY: ClassVar[uint8] = 63
    FIELD_TYPE_BYTE_ARRAY: ClassVar[uint8] = 64
    FIELD_TYPE_STRING_ARRAY: ClassVar[uint8] = 65
    FIELD_TYPE_WSTRING_ARRAY: ClassVar[uint8] = 66
    FIELD_TYPE_FIXED_STRING_ARRAY: ClassVar[uint8] = 67
    FIELD_TYPE_FIXED_WSTRING_ARRAY: ClassVar[uint8] = 68
    FIELD_TYPE_BOUNDED_STRING_ARRAY: ClassVar[uint8] = 69
    FIELD_TYPE_BOUNDED_WSTRING_ARRAY: ClassVar[uint8] = 70
    FIELD_TYPE_NESTED_TYPE_BOUNDED_SEQUENCE: ClassVar[uint8] = 97
    FIELD_TYPE_INT8_BOUNDED_SEQUENCE: ClassVar[uint8] = 98
    FIELD_TYPE_UINT8_BOUNDED_SEQUENCE: ClassVar[uint8] = 99
    FIELD_TYPE_INT16_BOUNDED_SEQUENCE: ClassVar[uint8] = 100
    FIELD_TYPE_UINT16_BOUNDED_SEQUENCE: ClassVar[uint8] = 101
    FIELD_TYPE_INT32_BOUNDED_SEQUENCE: ClassVar[uint8] = 102
    FIELD_TYPE_UINT32_BOUNDED_SEQUENCE: ClassVar[uint8] = 103
    FIELD_TYPE_INT64_BOUNDED_SEQUENCE: ClassVar[uint8] = 104
    FIELD_TYPE_UINT64_BOUNDED_SEQUENCE: ClassVar[uint8] = 105
    FIELD_TYPE_FLOAT_BOUNDED_SEQUENCE: ClassVar[uint8] = 106
    FIELD_TYPE_DOUBLE_BOUNDED_SEQUENCE: ClassVar[uint8] = 107
    FIELD_TYPE_LONG_DOUBLE_BOUNDED_SEQUENCE: ClassVar[uint8] = 108
    FIELD_TYPE_CHAR_BOUNDED_SEQUENCE: ClassVar[uint8] = 109
    FIELD_TYPE_WCHAR_BOUNDED_SEQUENCE: ClassVar[uint8] = 110
    FIELD_TYPE_BOOLEAN_BOUNDED_SEQUENCE: ClassVar[uint8] = 111
    FIELD_TYPE_BYTE_BOUNDED_SEQUENCE: ClassVar[uint8] = 112
    FIELD_TYPE_STRING_BOUNDED_SEQUENCE: ClassVar[uint8] = 113
    FIELD_TYPE_WSTRING_BOUNDED_SEQUENCE: ClassVar[uint8] = 114
    FIELD_TYPE_FIXED_STRING_BOUNDED_SEQUENCE: ClassVar[uint8] = 115
    FIELD_TYPE_FIXED_WSTRING_BOUNDED_SEQUENCE: ClassVar[uint8] = 116
    FIELD_TYPE_BOUNDED_STRING_BOUNDED_SEQUENCE: ClassVar[uint8] = 117
    FIELD_TYPE_BOUNDED_WSTRING_BOUNDED_SEQUENCE: ClassVar[uint8] = 118
    FIELD_TYPE_NESTED_TYPE_UNBOUNDED_SEQUENCE: ClassVar[uint8] = 145
    FIELD_TYPE_INT8_UNBOUNDED_SEQUENCE: ClassVar[uint8] = 146
    FIELD_TYPE_UINT8_UNBOUNDED_SEQUENCE: ClassVar[uint8] = 147
    FIELD_TYPE_INT16_UNBOUNDED_SEQUENCE: ClassVar[uint8] = 148
    FIELD_TYPE_UINT16_UNBOUNDED_SEQUENCE: ClassVar[uint8] = 149
    FIELD_TYPE_INT32_UNBOUNDED_SEQUENCE: ClassVar[uint8] = 150
    FIELD_TYPE_UINT32_UNBOUNDED_SEQUENCE: ClassVar[uint8] = 151
    FIELD_TYPE_INT64_UNBOUNDED_SEQUENCE: ClassVar[uint8] = 152
    FIELD_TYPE_UINT64_UNBOUNDED_SEQUENCE: ClassVar[uint8] = 153
    FIELD_TYPE_FLOAT_UNBOUNDED_SEQUENCE: ClassVar[uint8] = 154
    FIELD_TYPE_DOUBLE_UNBOUNDED_SEQUENCE: ClassVar[uint8] = 155
    FIELD_TYPE_LONG_DOUBLE_UNBOUNDED_SEQUENCE: ClassVar[uint8] = 156
    FIELD_TYPE_CHAR_UNBOUNDED_SEQUENCE: ClassVar[uint8] = 157
    FIELD_TYPE_WCHAR_UNBOUNDED_SEQUENCE: ClassVar[uint8] = 158
    FIELD_TYPE_BOOLEAN_UNBOUNDED_SEQUENCE: ClassVar[uint8] = 159
    FIELD_TYPE_BYTE_UNBOUNDED_SEQUENCE: ClassVar[uint8] = 160
    FIELD_TYPE_STRING_UNBOUNDED_SEQUENCE: ClassVar[uint8] = 161
    FIELD_TYPE_WSTRING_UNBOUNDED_SEQUENCE: ClassVar[uint8] = 162
    FIELD_TYPE_FIXED_STRING_UNBOUNDED_SEQUENCE: ClassVar[uint8] = 163
    FIELD_TYPE_FIXED_WSTRING_UNBOUNDED_SEQUENCE: ClassVar[uint8] = 164
    FIELD_TYPE_BOUNDED_STRING_UNBOUNDED_SEQUENCE: ClassVar[uint8] = 165
    FIELD_TYPE_BOUNDED_WSTRING_UNBOUNDED_SEQUENCE: ClassVar[uint8] = 166

    type_id: uint8 = 0
    capacity: uint64
    string_capacity: uint64
    nested_type_name: Annotated[string, AtMost(255)]


class Field(Message):
    """One field of a type; `default_value` is the literal as it stood in the .msg file, or empty."""

    name: string
    type: FieldType
    default_value: string


class IndividualTypeDescription(Message):
    """One type: its full name and its fields in their order."""

    type_name: Annotated[string, AtMost(255)]
    fields: Sequence[Field]


class TypeDescription(Message):
    """A type and, sorted by name, every type that it is made of."""

    type_description: IndividualTypeDescription
    referenced_type_descriptions: Sequence[IndividualTypeDescription]


class TypeSource(Message):
    """The text in which a type was written.

    `encoding` is the ending of its file, ``msg``, ``srv``, ``action`` or ``idl``. It is ``implicit`` for what is
    part of a service or action and ``dynamic`` for what a program made; these have no text.
    """

    type_name: string
    encoding: string
    raw_file_contents: string


class KeyValue(Message):
    """A named piece of information, both as text."""

    key: string
    value: string
