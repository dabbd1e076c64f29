"""Parameters: names with typed values, and their conversion to and from messages and files."""

from __future__ import annotations

import array
import os
import warnings
from collections.abc import Sequence
from enum import IntEnum
from typing import Any, Generic, TypeAlias, TypeVar, cast, overload

from robolink.exceptions import nearest
from robolink.interfaces.rcl_interfaces.msg import Parameter as ParameterMsg
from robolink.interfaces.rcl_interfaces.msg import ParameterType, ParameterValue

PARAMETER_SEPARATOR_STRING = "."

AllowableParameterValue: TypeAlias = Any
"""Value of a parameter: None, bool, int, float, str, or a list, tuple or array of bytes, bool, int, float or str."""

AllowableParameterValueT = TypeVar("AllowableParameterValueT")


class Parameter(Generic[AllowableParameterValueT]):
    """Name with a typed value, immutable: `Parameter("speed", value=0.3)`.

    Args:
        name: Name of the parameter; dots nest.
        type_: Type of the value; None takes it from the value.
        value: Value: None, bool, int, float, str, or a list of bool, int, float, str or of bytes of length 1.

    Raises:
        ValueError: if type and value do not agree.
        TypeError: if the value is of no parameter's type, or `type_` is not a Parameter.Type.
    """

    class Type(IntEnum):
        """Types of parameters, numbered as in rcl_interfaces/msg/ParameterType."""

        NOT_SET = ParameterType.PARAMETER_NOT_SET
        BOOL = ParameterType.PARAMETER_BOOL
        INTEGER = ParameterType.PARAMETER_INTEGER
        DOUBLE = ParameterType.PARAMETER_DOUBLE
        STRING = ParameterType.PARAMETER_STRING
        BYTE_ARRAY = ParameterType.PARAMETER_BYTE_ARRAY
        BOOL_ARRAY = ParameterType.PARAMETER_BOOL_ARRAY
        INTEGER_ARRAY = ParameterType.PARAMETER_INTEGER_ARRAY
        DOUBLE_ARRAY = ParameterType.PARAMETER_DOUBLE_ARRAY
        STRING_ARRAY = ParameterType.PARAMETER_STRING_ARRAY

        @classmethod
        def from_parameter_value(cls, parameter_value: AllowableParameterValue) -> Parameter.Type:
            """Return the type of `parameter_value`; an empty list is a BYTE_ARRAY. Raises TypeError if it has none."""
            if parameter_value is None:
                return cls.NOT_SET
            is_list = isinstance(parameter_value, _ARRAYS)
            for name, item in (_ITEMS if is_list else _SCALARS).items():
                if _all_are(parameter_value, item) if is_list else isinstance(parameter_value, item):
                    return cls[name]
            what = "a list of one of the allowed types" if is_list else "one of the allowed types"
            raise TypeError(f"the given value is not {what}: {parameter_value!r}")

        def check(self, parameter_value: AllowableParameterValue) -> bool:
            """True if `parameter_value` is of this type: an int is not a DOUBLE, a bool is an INTEGER, as in rclpy."""
            if self is Parameter.Type.NOT_SET:
                return parameter_value is None
            if self.name in _SCALARS:
                return isinstance(parameter_value, _SCALARS[self.name])
            item = _ITEMS[self.name]
            kinds = _ARRAYS if item in (int, float) else _LISTS
            if not isinstance(parameter_value, kinds) or not _all_are(parameter_value, item):
                return False
            return item is not bytes or all(len(each) == 1 for each in parameter_value)

    @overload
    def __init__(self, name: str, type_: Parameter.Type | None = None) -> None: ...

    @overload
    def __init__(self, name: str, type_: Parameter.Type, value: AllowableParameterValueT) -> None: ...

    @overload
    def __init__(self, name: str, *, value: AllowableParameterValueT) -> None: ...

    def __init__(self, name: str, type_: Parameter.Type | None = None, value: AllowableParameterValue = None) -> None:
        if type_ is None:
            type_ = Parameter.Type.from_parameter_value(value)
        if not isinstance(type_, Parameter.Type):
            raise TypeError(f"type_ must be a Parameter.Type, got {type_!r}")
        if not type_.check(value):
            raise ValueError(f"parameter '{name}': the type {type_.name} and the value {value!r} do not agree")
        self._name, self._type, self._value = name, type_, value

    @property
    def name(self) -> str:
        """Name of the parameter; dots nest."""
        return self._name

    @property
    def type_(self) -> Parameter.Type:
        """Type of the value."""
        return self._type

    @property
    def value(self) -> AllowableParameterValueT:
        """Value, as it was given."""
        return cast("AllowableParameterValueT", self._value)

    def __repr__(self) -> str:
        return f"Parameter(name={self._name!r}, type_={self._type.name}, value={self._value!r})"

    @classmethod
    def from_parameter_msg(cls, param_msg: ParameterMsg) -> Parameter[AllowableParameterValueT]:
        """Return the parameter of `param_msg`, rcl_interfaces/msg/Parameter. Raises ValueError for an unknown type."""
        type_ = Parameter.Type(param_msg.value.type)
        if type_ is Parameter.Type.NOT_SET:
            return cls(param_msg.name, type_)
        return cls(param_msg.name, type_, getattr(param_msg.value, _field(type_)))

    def get_parameter_value(self) -> ParameterValue:
        """Return the value as an rcl_interfaces/msg/ParameterValue."""
        message = ParameterValue(type=self._type.value)
        if self._type is not Parameter.Type.NOT_SET:
            setattr(message, _field(self._type), self._value)
        return message

    def to_parameter_msg(self) -> ParameterMsg:
        """Return the parameter as an rcl_interfaces/msg/Parameter."""
        return ParameterMsg(name=self._name, value=self.get_parameter_value())


_LISTS = (list, tuple)
_ARRAYS = (*_LISTS, array.array)
# In the order in which a value is tried: every bool is an int.
_SCALARS = {"BOOL": bool, "INTEGER": int, "DOUBLE": float, "STRING": str}
_ITEMS = {
    "BYTE_ARRAY": bytes,
    "BOOL_ARRAY": bool,
    "INTEGER_ARRAY": int,
    "DOUBLE_ARRAY": float,
    "STRING_ARRAY": str,
}


def _all_are(values: Sequence[object], item: type) -> bool:
    return all(isinstance(each, item) for each in values)


def _field(type_: Parameter.Type) -> str:
    return f"{type_.name.lower()}_value"


def get_parameter_value(string_value: str) -> ParameterValue:
    """Parse `string_value`, text of a command line, as YAML; what is not one value, or has no type, stays a string.

    The rules are PyYAML's, as in rclpy, and not those of parameter files: 1e3 is a string, and [] a list of booleans.

    >>> get_parameter_value("[1, 2]").type == ParameterType.PARAMETER_INTEGER_ARRAY
    True
    """
    import yaml  # late: most programs never read text

    try:
        value = yaml.safe_load(string_value)
    except (yaml.YAMLError, ValueError, RecursionError):  # ValueError: a date with a 32nd day
        value = string_value
    if value == []:
        return ParameterValue(type=ParameterType.PARAMETER_BOOL_ARRAY)
    return Parameter("", value=value if _is_value(value) else string_value).get_parameter_value()


def _is_value(value: object) -> bool:
    """Return whether a parameter can have a value of YAML: text, a number of 64 bits, a boolean, or a list of one."""
    if isinstance(value, list):
        return any(_all_are(value, each) for each in _SCALARS.values()) and all(map(_is_value, value))
    return isinstance(value, (bool, float, str)) or (isinstance(value, int) and -(2**63) <= value < 2**63)


def parameter_value_to_python(parameter_value: ParameterValue) -> AllowableParameterValue:
    """Return the plain value of `parameter_value`, a ParameterValue: None if it is not set, arrays as lists.

    Raises RuntimeError for an unknown type.
    """
    try:
        type_ = Parameter.Type(parameter_value.type)
    except ValueError:
        raise RuntimeError(f"unexpected parameter type {parameter_value.type}") from None
    if type_ is Parameter.Type.NOT_SET:
        return None
    value = getattr(parameter_value, _field(type_))
    return list(value) if type_.name in _ITEMS else value


def parameter_dict_from_yaml_file(
    parameter_file: str | os.PathLike[str],
    use_wildcard: bool = False,
    target_nodes: Sequence[str] | None = None,
    namespace: str = "",
) -> dict[str, ParameterMsg]:
    """Read the parameters of a ROS parameter file, and return them as messages by name.

    Args:
        parameter_file: Path of the file.
        use_wildcard: True adds those of the section `/**`, which the others override.
        target_nodes: Full names of the nodes whose sections to read; None or none reads those of all nodes.
        namespace: Text that is prepended to each parameter's name as it is.

    Raises:
        FileNotFoundError: if there is no such file.
        ParameterFileError: (a RuntimeError) if it is not a ROS parameter file, or has no section for any target node.

    Warns (RuntimeWarning) of a target node without a section where another one has any.
    """
    from robolink.arguments.parameter_file import ParameterFileError, read_parameter_file

    overrides = read_parameter_file(parameter_file)
    sections = list(dict.fromkeys(each.pattern for each in overrides))
    expected = _sections_of(sections, use_wildcard, target_nodes)
    missing = [each for each in expected if each not in sections]
    if missing:
        hint = nearest(missing[0], sections) or f": it has {', '.join(sections) or 'none'}"
        text = f"{parameter_file}:1:1: no parameters for node '{missing[0]}'{hint}"
        if len(missing) == len(expected):
            raise ParameterFileError(text)
        warnings.warn(text, RuntimeWarning, stacklevel=2)
    if not expected:
        raise ParameterFileError(f"{parameter_file}:1:1: no parameters for the nodes asked for")
    values = {namespace + each.name: each.value for part in expected for each in overrides if each.pattern == part}
    return {name: Parameter(name, value=value).to_parameter_msg() for name, value in values.items()}


def _sections_of(sections: Sequence[str], use_wildcard: bool, target_nodes: Sequence[str] | None) -> list[str]:
    wildcard = [each for each in sections if use_wildcard and each == "/**"]
    if target_nodes:
        return wildcard + [f"/{node.strip('/')}" for node in target_nodes]
    return wildcard + [each for each in sections if each != "/**"]
