"""Descriptors of parameters, made in one line: description, range and `read_only`."""

from __future__ import annotations

from robolink.interfaces.rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor


def described(
    description: str, low: int | float | None = None, high: int | float | None = None, *, read_only: bool = False
) -> ParameterDescriptor:
    """Return the descriptor of a parameter.

        node.declare_parameter("speed", 0.3, described("m/s", 0.0, 2.0))

    Args:
        description: Text for people: what the parameter means, and its unit.
        low: Smallest value that is not refused, an int for an integer parameter, a float for a double; None with
            `high` for no range. NaN lies in no range.
        high: Largest value that is not refused, of the same type.
        read_only: True keeps the value that the parameter has when it is declared.
    """
    descriptor = ParameterDescriptor(description=description, read_only=read_only)
    if isinstance(low, int) and isinstance(high, int):
        descriptor.integer_range = [IntegerRange(from_value=low, to_value=high)]
    elif low is not None and high is not None:
        descriptor.floating_point_range = [FloatingPointRange(from_value=low, to_value=high)]
    return descriptor
