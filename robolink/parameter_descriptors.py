"""Descriptors of parameters in one line: what a parameter is for, and which numbers it may hold."""

from __future__ import annotations

from robolink.interfaces.rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor


def described(
    description: str, low: int | float | None = None, high: int | float | None = None, *, read_only: bool = False
) -> ParameterDescriptor:
    """Describe a parameter, and refuse what is not from `low` to `high`: two floats for a double, two ints for an int.

    NaN lies in no range. A read-only parameter keeps the value that it has when it is declared::

        node.declare_parameter("speed", 0.3, described("m/s", 0.0, 2.0))
    """
    descriptor = ParameterDescriptor(description=description, read_only=read_only)
    if isinstance(low, int) and isinstance(high, int):
        descriptor.integer_range = [IntegerRange(from_value=low, to_value=high)]
    elif low is not None and high is not None:
        descriptor.floating_point_range = [FloatingPointRange(from_value=low, to_value=high)]
    return descriptor
