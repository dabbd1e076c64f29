"""Rules of parameters: how a declaration is read, and which values a descriptor lets through."""

from __future__ import annotations

import copy
import math
from collections.abc import Collection, Mapping, Sequence
from typing import Any, NamedTuple

from robolink.exceptions import EncodeError, InvalidParameterValueException
from robolink.interfaces.rcl_interfaces.msg import (
    FloatingPointRange,
    IntegerRange,
    ParameterDescriptor,
    ParameterEvent,
    ParameterValue,
)
from robolink.message import encode
from robolink.parameter import PARAMETER_SEPARATOR_STRING, Parameter
from robolink.system.terminal import shown
from robolink.validate_parameter_name import validate_parameter_name

Type = Parameter.Type

# rclpy's own words: its tests compare them.
EMPTY_LIST = (
    "parameter list cannot be empty, this might be due to pre_set_parameters_callback "
    "modifying the original parameters list."
)
INVALID_RESULT = "Callback returned an invalid type"


class Declaration(NamedTuple):
    """Declaration: the parameter as it will first be, and its descriptor, which nobody else holds."""

    parameter: Parameter[Any]
    descriptor: ParameterDescriptor


class WrittenParameter(Parameter[Any]):
    """Parameter whose value was written on a command line or in a file: `1` there may be meant as 1.0.

    A program that gives a `Parameter` has said which of the two it is.
    """

    def as_type(self, type_: Parameter.Type) -> Parameter[Any]:
        """Return the parameter as it was meant, if it is declared with a type: integers for doubles are doubles."""
        # rclpy refuses these, and every class stumbles over `-p speed:=1`.
        if type_ is Parameter.Type.DOUBLE and self.type_ is Parameter.Type.INTEGER:
            return Parameter(self.name, type_, float(self.value))
        if type_ is Parameter.Type.DOUBLE_ARRAY and self.type_ is Parameter.Type.INTEGER_ARRAY:
            return Parameter(self.name, type_, [float(each) for each in self.value])
        return Parameter(self.name, self.type_, self.value)


def read_declaration(
    entry: Sequence[Any], index: int, namespace: str, overrides: Mapping[str, Parameter[Any]]
) -> Declaration:
    """Read entry number `index` of a list of declarations: (name,), (name, value) or (name, value, descriptor).

    The value may be a `Parameter.Type`, or None where the type is dynamic; an override goes before it. Raises
    TypeError for a tuple of another form, InvalidParameterException for the name, and ValueError where neither
    value nor type is given, or both a type and dynamic typing.
    """
    _check_form(entry, index)
    name = f"{namespace}.{entry[0]}" if namespace else entry[0]
    validate_parameter_name(name)
    value = entry[1] if len(entry) > 1 else None
    descriptor = copy.copy(entry[2]) if len(entry) > 2 else ParameterDescriptor(dynamic_typing=len(entry) == 1)
    descriptor.name = name
    if isinstance(value, Type) or not descriptor.dynamic_typing:
        descriptor.type = _static_type(name, value, descriptor.dynamic_typing)
    return Declaration(_first_value(name, value, descriptor, overrides.get(name)), descriptor)


def _check_form(entry: Sequence[Any], index: int) -> None:
    if isinstance(entry, str) or not 1 <= len(entry) <= 3:
        raise TypeError(f"declaration {index}: expected a tuple (name, value, descriptor), got {entry!r}")
    if not isinstance(entry[0], str):
        raise TypeError(f"declaration {index}: the name must be a str, got {entry[0]!r}")
    if len(entry) > 2 and not isinstance(entry[2], ParameterDescriptor):
        raise TypeError(f"declaration {index}, '{entry[0]}': expected a ParameterDescriptor, got {entry[2]!r}")


def _static_type(name: str, value: Any, dynamic_typing: bool) -> int:
    if isinstance(value, Type) and dynamic_typing:
        raise ValueError(f"parameter '{name}': a type ({value.name}) and dynamic_typing exclude each other")
    if isinstance(value, Type):
        type_ = value.value
    elif isinstance(value, ParameterValue):
        type_ = value.type
    else:
        type_ = _parameter(name, value).type_.value
    if type_ == Type.NOT_SET:
        raise ValueError(
            f"parameter '{name}' has neither value nor type: give a default value, a Parameter.Type "
            "or a ParameterDescriptor(dynamic_typing=True)"
        )
    return type_


def _first_value(
    name: str, value: Any, descriptor: ParameterDescriptor, override: Parameter[Any] | None
) -> Parameter[Any]:
    if override is not None:
        return as_declared(override, descriptor)
    if isinstance(value, ParameterValue):
        raise ValueError(f"parameter '{name}': a ParameterValue is not a default value, and no override is given")
    return Parameter(name) if isinstance(value, Type) else _parameter(name, value)


def as_declared(override: Parameter[Any], descriptor: ParameterDescriptor) -> Parameter[Any]:
    """Read an override as its declaration has it: an empty list does not say of what, nor 1 whether it is a double."""
    if isinstance(override, WrittenParameter):
        override = override.as_type(Type.NOT_SET if descriptor.dynamic_typing else Type(descriptor.type))
    is_empty = isinstance(override.value, list) and not override.value
    if is_empty and not descriptor.dynamic_typing and Type(descriptor.type).check(override.value):
        return Parameter(override.name, Type(descriptor.type), override.value)
    return override


def leniency(given: Parameter[Any] | None, declared: Parameter[Any]) -> str:
    """Return ROS 2's answer to a written override that was accepted here, or '' if ROS 2 accepts it, too."""
    if not isinstance(given, WrittenParameter):
        return ""
    if given.value == []:
        return f"parameter '{given.name}' was given an empty list: in ROS 2 it has no value then"
    if given.type_ is not declared.type_ and declared.type_ in (Type.DOUBLE, Type.DOUBLE_ARRAY):
        return (
            f"parameter '{given.name}' is a {declared.type_.name} and was given {given.value}: "
            f"ROS 2 refuses integers for it, so write {declared.value}"
        )
    return ""


def _parameter(name: str, value: Any) -> Parameter[Any]:
    try:
        return Parameter(name, value=value)
    except TypeError as error:
        raise TypeError(f"parameter '{name}': {error}") from None


def has_wrong_type(parameter: Parameter[Any], descriptor: ParameterDescriptor) -> bool:
    """True if a value is of another type than its static descriptor demands; no value is of every type."""
    if descriptor.dynamic_typing or parameter.type_ is Type.NOT_SET:
        return False
    return bool(parameter.type_ != descriptor.type)


def refusal(parameter: Parameter[Any], descriptor: ParameterDescriptor, *, is_declared: bool, rel_tol: float) -> str:
    """Return the reason why a descriptor refuses a value, or ''; `read_only` is not looked at.

    `rel_tol` is the tolerance of a float towards an end or a step of its range, relative to the greater of the two.
    """
    if has_wrong_type(parameter, descriptor):
        expected = Type(descriptor.type).name
        return f"Wrong parameter type for '{parameter.name}': expected {expected}, got {parameter.type_.name}"
    if parameter.type_ is Type.NOT_SET and is_declared and not descriptor.dynamic_typing:
        return "Static parameter cannot be undeclared"
    reason = ""
    if parameter.type_ is Type.INTEGER:
        reason = _integer_refusal(parameter, descriptor.integer_range)
    elif parameter.type_ is Type.DOUBLE and descriptor.floating_point_range:
        reason = _float_refusal(parameter, descriptor.floating_point_range[0], rel_tol)
    return reason or _unsendable(parameter)


def first_fitting(
    candidates: Sequence[Parameter[Any]], descriptor: ParameterDescriptor, rel_tol: float
) -> Parameter[Any]:
    """Return the first candidate that a new descriptor lets through. Raises InvalidParameterValueException for none."""
    reason = ""
    for candidate in candidates:
        reason = refusal(candidate, descriptor, is_declared=True, rel_tol=rel_tol)
        if not reason:
            return candidate
    raise InvalidParameterValueException(candidates[-1].name, candidates[-1].value, reason)


def _unsendable(parameter: Parameter[Any]) -> str:
    """Return the reason why a parameter cannot be sent, or '': a number too great, or text that is not Unicode."""
    try:
        encode(parameter.to_parameter_msg())
    except EncodeError as error:
        return f"parameter '{shown(parameter.name)}': {error}"
    return ""


def _integer_refusal(parameter: Parameter[int], ranges: Sequence[IntegerRange]) -> str:
    value = parameter.value
    if not -(2**63) <= value < 2**63:
        return f"parameter '{parameter.name}': {value} does not fit in 64 bits"
    if not ranges:
        return ""
    low, high = sorted((ranges[0].from_value, ranges[0].to_value))
    if value in (low, high):
        return ""
    if not low < value < high:
        return _out_of_range(parameter, low, high)
    step = ranges[0].step
    return _no_step(parameter, low, high, step) if step and (value - low) % step else ""


def _float_refusal(parameter: Parameter[float], limits: FloatingPointRange, rel_tol: float) -> str:
    value, step = parameter.value, limits.step
    low, high = min(limits.from_value, limits.to_value), max(limits.from_value, limits.to_value)
    if math.isclose(value, low, rel_tol=rel_tol) or math.isclose(value, high, rel_tol=rel_tol):
        return ""
    if not low < value < high:
        return _out_of_range(parameter, low, high)
    if not step or math.isinf(value - low):
        return ""
    nearest_step = value - math.remainder(value - low, step)
    # The absolute part lets a zero in the middle of a range be a step: rounding leaves some 1e-16 in its place.
    near = math.isclose(value, nearest_step, rel_tol=rel_tol, abs_tol=4 * math.ulp(low))
    return "" if near else _no_step(parameter, low, high, step)


def _out_of_range(parameter: Parameter[Any], low: float, high: float) -> str:
    return f"parameter '{parameter.name}' out of range: {parameter.value} is not within {low} to {high}"


def _no_step(parameter: Parameter[Any], low: float, high: float, step: float) -> str:
    return f"parameter '{parameter.name}' off its steps: {parameter.value} is not {low}, {high} or {low} + n * {step}"


def record(
    parameters: Sequence[Parameter[Any]],
    values: dict[str, Parameter[Any]],
    descriptors: dict[str, ParameterDescriptor],
    declaring: ParameterDescriptor | None,
) -> ParameterEvent:
    """Write parameters that may be set into `values` and `descriptors`; return the event, without node and stamp.

    A parameter without value is taken out, unless it is being declared with the descriptor `declaring`.
    """
    event = ParameterEvent()
    for parameter in parameters:
        name, message = parameter.name, parameter.to_parameter_msg()
        if parameter.type_ is Type.NOT_SET and declaring is None:
            event.deleted_parameters.append(message)
            values.pop(name, None)
            descriptors.pop(name, None)
            continue
        before = values.get(name)
        is_new = before is None or before.type_ is Type.NOT_SET
        (event.new_parameters if is_new else event.changed_parameters).append(message)
        descriptor = declaring or descriptors.get(name) or ParameterDescriptor(dynamic_typing=True)
        values[name], descriptors[name] = parameter, describing(parameter, descriptor)
    return event


def describing(parameter: Parameter[Any], descriptor: ParameterDescriptor) -> ParameterDescriptor:
    """Write into a descriptor what it says of the parameter itself: the name, and a type that is not fixed."""
    descriptor.name = parameter.name
    if descriptor.dynamic_typing:
        descriptor.type = parameter.type_.value
    return descriptor


def check_names(names: Sequence[str]) -> None:
    """Raise TypeError for a name that is not a str."""
    for name in names:
        if not isinstance(name, str):
            raise TypeError(f"a parameter's name must be a str, got {name!r}")


def is_listed(name: str, prefixes: Collection[str], depth: int) -> bool:
    """True if `list_parameters` names a parameter: it is one of the prefixes, or lies up to `depth` below one.

    Without prefixes all names lie below. A depth of 0 has no end. Any number of prefixes, given as a set, takes the
    same time: who asks may be anybody.
    """
    if not prefixes:
        return depth == 0 or name.count(PARAMETER_SEPARATOR_STRING) < depth
    above, dot, below = name, ".", 0
    while dot and (depth == 0 or below <= depth):
        if above in prefixes:
            return True
        above, dot, _ = above.rpartition(PARAMETER_SEPARATOR_STRING)
        below += 1
    return False
