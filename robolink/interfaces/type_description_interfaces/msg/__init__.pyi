# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message
import robolink.interfaces.type_description_interfaces.msg

__all__ = ["Field", "FieldType", "IndividualTypeDescription", "KeyValue", "TypeDescription", "TypeSource"]

class Field(robolink.message.Message):
    """One field of a type; `default_value` is the literal as it stood in the .msg file, or empty."""
    name: builtins.str
    type: robolink.interfaces.type_description_interfaces.msg.FieldType
    default_value: builtins.str
    def __init__(self, *, name: builtins.str = ..., type: robolink.interfaces.type_description_interfaces.msg.FieldType = ..., default_value: builtins.str = ...) -> None: ...
class FieldType(robolink.message.Message):
    """The type of one field: a code, and the numbers and the name that some codes need.

    Codes 1 to 48 stand for single values. The same code plus 48 is a fixed array of them, plus 96 a bounded
    sequence, plus 144 a sequence of any length. `capacity` is the length of an array, or the most elements that a
    bounded sequence takes; `string_capacity` the most characters of a bounded string; `nested_type_name`
    (``package/msg/Name``) the type of a nested message. What does not apply is 0 or empty.
    """
    FIELD_TYPE_NOT_SET: typing.ClassVar[builtins.int]
    FIELD_TYPE_NESTED_TYPE: typing.ClassVar[builtins.int]
    FIELD_TYPE_INT8: typing.ClassVar[builtins.int]
    FIELD_TYPE_UINT8: typing.ClassVar[builtins.int]
    FIELD_TYPE_INT16: typing.ClassVar[builtins.int]
    FIELD_TYPE_UINT16: typing.ClassVar[builtins.int]
    FIELD_TYPE_INT32: typing.ClassVar[builtins.int]
    FIELD_TYPE_UINT32: typing.ClassVar[builtins.int]
    FIELD_TYPE_INT64: typing.ClassVar[builtins.int]
    FIELD_TYPE_UINT64: typing.ClassVar[builtins.int]
    FIELD_TYPE_FLOAT: typing.ClassVar[builtins.int]
    FIELD_TYPE_DOUBLE: typing.ClassVar[builtins.int]
    FIELD_TYPE_LONG_DOUBLE: typing.ClassVar[builtins.int]
    FIELD_TYPE_CHAR: typing.ClassVar[builtins.int]
    FIELD_TYPE_WCHAR: typing.ClassVar[builtins.int]
    FIELD_TYPE_BOOLEAN: typing.ClassVar[builtins.int]
    FIELD_TYPE_BYTE: typing.ClassVar[builtins.int]
    FIELD_TYPE_STRING: typing.ClassVar[builtins.int]
    FIELD_TYPE_WSTRING: typing.ClassVar[builtins.int]
    FIELD_TYPE_FIXED_STRING: typing.ClassVar[builtins.int]
    FIELD_TYPE_FIXED_WSTRING: typing.ClassVar[builtins.int]
    FIELD_TYPE_BOUNDED_STRING: typing.ClassVar[builtins.int]
    FIELD_TYPE_BOUNDED_WSTRING: typing.ClassVar[builtins.int]
    FIELD_TYPE_NESTED_TYPE_ARRAY: typing.ClassVar[builtins.int]
    FIELD_TYPE_INT8_ARRAY: typing.ClassVar[builtins.int]
    FIELD_TYPE_UINT8_ARRAY: typing.ClassVar[builtins.int]
    FIELD_TYPE_INT16_ARRAY: typing.ClassVar[builtins.int]
    FIELD_TYPE_UINT16_ARRAY: typing.ClassVar[builtins.int]
    FIELD_TYPE_INT32_ARRAY: typing.ClassVar[builtins.int]
    FIELD_TYPE_UINT32_ARRAY: typing.ClassVar[builtins.int]
    FIELD_TYPE_INT64_ARRAY: typing.ClassVar[builtins.int]
    FIELD_TYPE_UINT64_ARRAY: typing.ClassVar[builtins.int]
    FIELD_TYPE_FLOAT_ARRAY: typing.ClassVar[builtins.int]
    FIELD_TYPE_DOUBLE_ARRAY: typing.ClassVar[builtins.int]
    FIELD_TYPE_LONG_DOUBLE_ARRAY: typing.ClassVar[builtins.int]
    FIELD_TYPE_CHAR_ARRAY: typing.ClassVar[builtins.int]
    FIELD_TYPE_WCHAR_ARRAY: typing.ClassVar[builtins.int]
    FIELD_TYPE_BOOLEAN_ARRAY: typing.ClassVar[builtins.int]
    FIELD_TYPE_BYTE_ARRAY: typing.ClassVar[builtins.int]
    FIELD_TYPE_STRING_ARRAY: typing.ClassVar[builtins.int]
    FIELD_TYPE_WSTRING_ARRAY: typing.ClassVar[builtins.int]
    FIELD_TYPE_FIXED_STRING_ARRAY: typing.ClassVar[builtins.int]
    FIELD_TYPE_FIXED_WSTRING_ARRAY: typing.ClassVar[builtins.int]
    FIELD_TYPE_BOUNDED_STRING_ARRAY: typing.ClassVar[builtins.int]
    FIELD_TYPE_BOUNDED_WSTRING_ARRAY: typing.ClassVar[builtins.int]
    FIELD_TYPE_NESTED_TYPE_BOUNDED_SEQUENCE: typing.ClassVar[builtins.int]
    FIELD_TYPE_INT8_BOUNDED_SEQUENCE: typing.ClassVar[builtins.int]
    FIELD_TYPE_UINT8_BOUNDED_SEQUENCE: typing.ClassVar[builtins.int]
    FIELD_TYPE_INT16_BOUNDED_SEQUENCE: typing.ClassVar[builtins.int]
    FIELD_TYPE_UINT16_BOUNDED_SEQUENCE: typing.ClassVar[builtins.int]
    FIELD_TYPE_INT32_BOUNDED_SEQUENCE: typing.ClassVar[builtins.int]
    FIELD_TYPE_UINT32_BOUNDED_SEQUENCE: typing.ClassVar[builtins.int]
    FIELD_TYPE_INT64_BOUNDED_SEQUENCE: typing.ClassVar[builtins.int]
    FIELD_TYPE_UINT64_BOUNDED_SEQUENCE: typing.ClassVar[builtins.int]
    FIELD_TYPE_FLOAT_BOUNDED_SEQUENCE: typing.ClassVar[builtins.int]
    FIELD_TYPE_DOUBLE_BOUNDED_SEQUENCE: typing.ClassVar[builtins.int]
    FIELD_TYPE_LONG_DOUBLE_BOUNDED_SEQUENCE: typing.ClassVar[builtins.int]
    FIELD_TYPE_CHAR_BOUNDED_SEQUENCE: typing.ClassVar[builtins.int]
    FIELD_TYPE_WCHAR_BOUNDED_SEQUENCE: typing.ClassVar[builtins.int]
    FIELD_TYPE_BOOLEAN_BOUNDED_SEQUENCE: typing.ClassVar[builtins.int]
    FIELD_TYPE_BYTE_BOUNDED_SEQUENCE: typing.ClassVar[builtins.int]
    FIELD_TYPE_STRING_BOUNDED_SEQUENCE: typing.ClassVar[builtins.int]
    FIELD_TYPE_WSTRING_BOUNDED_SEQUENCE: typing.ClassVar[builtins.int]
    FIELD_TYPE_FIXED_STRING_BOUNDED_SEQUENCE: typing.ClassVar[builtins.int]
    FIELD_TYPE_FIXED_WSTRING_BOUNDED_SEQUENCE: typing.ClassVar[builtins.int]
    FIELD_TYPE_BOUNDED_STRING_BOUNDED_SEQUENCE: typing.ClassVar[builtins.int]
    FIELD_TYPE_BOUNDED_WSTRING_BOUNDED_SEQUENCE: typing.ClassVar[builtins.int]
    FIELD_TYPE_NESTED_TYPE_UNBOUNDED_SEQUENCE: typing.ClassVar[builtins.int]
    FIELD_TYPE_INT8_UNBOUNDED_SEQUENCE: typing.ClassVar[builtins.int]
    FIELD_TYPE_UINT8_UNBOUNDED_SEQUENCE: typing.ClassVar[builtins.int]
    FIELD_TYPE_INT16_UNBOUNDED_SEQUENCE: typing.ClassVar[builtins.int]
    FIELD_TYPE_UINT16_UNBOUNDED_SEQUENCE: typing.ClassVar[builtins.int]
    FIELD_TYPE_INT32_UNBOUNDED_SEQUENCE: typing.ClassVar[builtins.int]
    FIELD_TYPE_UINT32_UNBOUNDED_SEQUENCE: typing.ClassVar[builtins.int]
    FIELD_TYPE_INT64_UNBOUNDED_SEQUENCE: typing.ClassVar[builtins.int]
    FIELD_TYPE_UINT64_UNBOUNDED_SEQUENCE: typing.ClassVar[builtins.int]
    FIELD_TYPE_FLOAT_UNBOUNDED_SEQUENCE: typing.ClassVar[builtins.int]
    FIELD_TYPE_DOUBLE_UNBOUNDED_SEQUENCE: typing.ClassVar[builtins.int]
    FIELD_TYPE_LONG_DOUBLE_UNBOUNDED_SEQUENCE: typing.ClassVar[builtins.int]
    FIELD_TYPE_CHAR_UNBOUNDED_SEQUENCE: typing.ClassVar[builtins.int]
    FIELD_TYPE_WCHAR_UNBOUNDED_SEQUENCE: typing.ClassVar[builtins.int]
    FIELD_TYPE_BOOLEAN_UNBOUNDED_SEQUENCE: typing.ClassVar[builtins.int]
    FIELD_TYPE_BYTE_UNBOUNDED_SEQUENCE: typing.ClassVar[builtins.int]
    FIELD_TYPE_STRING_UNBOUNDED_SEQUENCE: typing.ClassVar[builtins.int]
    FIELD_TYPE_WSTRING_UNBOUNDED_SEQUENCE: typing.ClassVar[builtins.int]
    FIELD_TYPE_FIXED_STRING_UNBOUNDED_SEQUENCE: typing.ClassVar[builtins.int]
    FIELD_TYPE_FIXED_WSTRING_UNBOUNDED_SEQUENCE: typing.ClassVar[builtins.int]
    FIELD_TYPE_BOUNDED_STRING_UNBOUNDED_SEQUENCE: typing.ClassVar[builtins.int]
    FIELD_TYPE_BOUNDED_WSTRING_UNBOUNDED_SEQUENCE: typing.ClassVar[builtins.int]
    type_id: builtins.int
    capacity: builtins.int
    string_capacity: builtins.int
    nested_type_name: builtins.str
    def __init__(self, *, type_id: builtins.int = ..., capacity: builtins.int = ..., string_capacity: builtins.int = ..., nested_type_name: builtins.str = ...) -> None: ...
class IndividualTypeDescription(robolink.message.Message):
    """One type: its full name and its fields in their order."""
    type_name: builtins.str
    fields: collections.abc.MutableSequence[robolink.interfaces.type_description_interfaces.msg.Field]
    def __init__(self, *, type_name: builtins.str = ..., fields: collections.abc.Iterable[robolink.interfaces.type_description_interfaces.msg.Field] = ...) -> None: ...
class KeyValue(robolink.message.Message):
    """A named piece of information, both as text."""
    key: builtins.str
    value: builtins.str
    def __init__(self, *, key: builtins.str = ..., value: builtins.str = ...) -> None: ...
class TypeDescription(robolink.message.Message):
    """A type and, sorted by name, every type that it is made of."""
    type_description: robolink.interfaces.type_description_interfaces.msg.IndividualTypeDescription
    referenced_type_descriptions: collections.abc.MutableSequence[robolink.interfaces.type_description_interfaces.msg.IndividualTypeDescription]
    def __init__(self, *, type_description: robolink.interfaces.type_description_interfaces.msg.IndividualTypeDescription = ..., referenced_type_descriptions: collections.abc.Iterable[robolink.interfaces.type_description_interfaces.msg.IndividualTypeDescription] = ...) -> None: ...
class TypeSource(robolink.message.Message):
    """The text in which a type was written.

    `encoding` is the ending of its file, ``msg``, ``srv``, ``action`` or ``idl``. It is ``implicit`` for what is
    part of a service or action and ``dynamic`` for what a program made; these have no text.
    """
    type_name: builtins.str
    encoding: builtins.str
    raw_file_contents: builtins.str
    def __init__(self, *, type_name: builtins.str = ..., encoding: builtins.str = ..., raw_file_contents: builtins.str = ...) -> None: ...
