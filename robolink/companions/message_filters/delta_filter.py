"""Filters that pass on what differs from the message before: only the changes of a topic."""

from __future__ import annotations

import functools
from collections.abc import Callable, Sequence
from typing import Any

from robolink.companions.message_filters.simple_filter import SimpleFilter

__all__ = [
    "CachedComparisonHandler",
    "ComparisonFilter",
    "ComparisonHandler",
    "DeltaCompare",
    "DeltaFilter",
    "PathDeltaFilter",
    "SimpleFilter",
]
FieldGetter = Callable[[Any], Any]
"""Function that returns a value of a message."""
COMPARED = (bool, int, float, str)
"""Types of values that DeltaCompare compares."""


class ComparisonHandler:
    """Base class of rules that say which messages a ComparisonFilter passes on."""

    def message_fits(self, message: Any) -> bool:
        """Return whether `message` is passed on."""
        raise NotImplementedError

    def do_fields_fit(self, field_a: Any, field_b: Any) -> bool:
        """Return whether a field's value before (`field_a`) and now (`field_b`) make the message pass."""
        raise NotImplementedError


class CachedComparisonHandler(ComparisonHandler):
    """Base class of rules that compare fields of a message with those of the one that was passed on last.

    The first message passes; then one passes if any of its fields does by `do_fields_fit`, which a subclass defines.

    Args:
        field_getters: Functions that return the fields.
    """

    def __init__(self, field_getters: Sequence[FieldGetter] = ()) -> None:
        self._field_getters = field_getters
        self._message_cache: Any = None

    def message_fits(self, message: Any) -> bool:
        """Return whether `message` is passed on, and remember it then."""
        before = self._message_cache
        fits = before is None or any(self.do_fields_fit(get(before), get(message)) for get in self._field_getters)
        if fits:
            self._message_cache = message
        return fits


class DeltaCompare(CachedComparisonHandler):
    """Rule that passes a message if one of its fields has changed.

    Args:
        field_getters: Functions that return the fields: numbers, bools or texts.
    """

    def __init__(self, field_getters: Sequence[FieldGetter]) -> None:
        super().__init__(field_getters)

    def do_fields_fit(self, field_a: Any, field_b: Any) -> bool:
        """Return whether `field_a` and `field_b` differ. Raises TypeError for anything but numbers, bools and texts."""
        for each in (field_a, field_b):
            if not isinstance(each, COMPARED):
                expected = ", ".join(kind.__name__ for kind in COMPARED)
                raise TypeError(f"DeltaCompare compares fields of {expected}, not of {type(each).__name__}")
        return bool(field_a != field_b)


class ComparisonFilter(SimpleFilter):
    """Filter that passes on the messages of another that fit a rule.

    Args:
        comparison_handler: The rule.
        message_filter: Filter whose messages come in; `connectInput` may say it later.
    """

    def __init__(self, comparison_handler: ComparisonHandler, message_filter: SimpleFilter | None = None) -> None:
        super().__init__()
        self._comparison_handler = comparison_handler
        self.incoming_connection: int | None = None
        self.connectInput(message_filter)

    def add(self, message: Any) -> None:
        """Pass `message` on if it fits."""
        if self.message_fits(message):
            self.signalMessage(message)

    def message_fits(self, message: Any) -> bool:
        """Return whether `message` fits the rule."""
        return self._comparison_handler.message_fits(message)

    def connectInput(self, message_filter: SimpleFilter | None) -> None:  # noqa: N802
        """Take the output of `message_filter`. Raises RuntimeError if one is connected already."""
        if self.incoming_connection is not None:
            raise RuntimeError(f"this {type(self).__name__} already has an incoming connection")
        if message_filter is not None:
            self.incoming_connection = message_filter.registerCallback(self.add)


class DeltaFilter(ComparisonFilter):
    """Filter that passes on a message if a field has changed since the one that was passed on last.

        DeltaFilter([lambda odom: odom.pose.pose.position.x], Subscriber(node, Odometry, "odom"))

    Args:
        field_getters: Functions that return the fields: numbers, bools or texts.
        message_filter: Filter whose messages come in; `connectInput` may say it later.
    """

    def __init__(self, field_getters: Sequence[FieldGetter], message_filter: SimpleFilter | None = None) -> None:
        super().__init__(DeltaCompare(field_getters), message_filter)


class PathDeltaFilter(DeltaFilter):
    """DeltaFilter whose fields are named: ``PathDeltaFilter(["pose.pose.position.x"], subscriber)``.

    Args:
        field_path_list: Paths of the fields, with dots.
        message_filter: Filter whose messages come in; `connectInput` may say it later.
    """

    def __init__(self, field_path_list: Sequence[str], message_filter: SimpleFilter | None = None) -> None:
        getters = [functools.partial(self.get_field_by_path, field_path=each) for each in field_path_list]
        super().__init__(getters, message_filter)

    def get_field_by_path(self, message: Any, field_path: str) -> Any:
        """Return the field of `message` at `field_path`. Raises RuntimeError that names the part that is not there."""
        found = message
        for name in field_path.split("."):
            before, found = found, getattr(found, name, None)
            if found is None:
                raise RuntimeError(f"{type(before).__name__} has no field '{name}' (path '{field_path}')")
        return found
