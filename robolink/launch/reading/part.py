"""A part of a launch file, such as a node or a group, with what stands for each `{name}` in it."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, NamedTuple, TypeVar

from robolink.exceptions import DocumentError, NameValidationException, RobolinkError, shown
from robolink.launch.reading.description import Count
from robolink.launch.reading.file import LaunchFile
from robolink.launch.reading.substitution import (
    NUMBER,
    Renamed,
    Step,
    SubstitutionError,
    Value,
    Values,
    filled,
    is_null,
)

T = TypeVar("T")

_TYPED = ("parameters", "arguments", "count", "if", "unless", "interactive", "cpu", "respawn")
"""Where `{name}` may stand for something else than a text."""
_DECIDES = ("if", "unless", "interactive")
"""What is true or false, and nothing else."""
_COLLECTIONS = ("args", "run", "env", "remappings")
"""Where it may stand for all that is said there; within, for texts."""
_AS_WRITTEN = ("args", "run", "env")
"""What programs get letter by letter: `012` is no number there, nor `1.10`, nor `true` anything else."""


class Part:
    """A mapping in a launch file, of which each key is filled in when it is asked for.

    A key with nothing but a `{name}` that stands for null is not there. All methods raise `DocumentError` for what is
    wrong.
    """

    def __init__(self, file: LaunchFile, steps: Sequence[Step], written: Mapping[str, Any], values: Values) -> None:
        self.file, self.steps, self.values = file, tuple(steps), values
        self.written = {key: data for key, data in written.items() if key in _DECIDES or not is_null(data, values)}
        self._renamed: Renamed = {}

    def __contains__(self, key: str) -> bool:
        return key in self.written

    def get(self, key: str, default: Any = None) -> Any:
        """Give what is said under a key, filled in."""
        if key not in self.written:
            return default
        data, steps = self.written[key], (*self.steps, key)
        is_typed = key in _TYPED or (key in _COLLECTIONS and isinstance(data, str))
        try:
            return _as_ros_spells(key, filled(data, self.values, steps, as_text=not is_typed, renamed=self._renamed))
        except SubstitutionError as error:
            raise self.file.error(error.steps, str(error), key=error.is_key) from None

    def read(self, type_: Any, *, without: Sequence[str] = ()) -> Any:
        """Make a value of a Struct out of all keys but some."""
        data = {key: self.get(key) for key in self.written if key not in without}
        return self.file.value(data, type_, self.steps)

    def value(self, key: str, type_: Any, default: Any) -> Any:
        """Make a value of a type out of what one key says."""
        return self.file.value(self.get(key), type_, (*self.steps, key)) if key in self.written else default

    def values_in(self, key: str) -> dict[str, Value]:
        """Give what the mapping under a key says, each value with the letters that it is written with."""
        said: dict[str, Any] = self.get(key, {})
        result = {}
        for name, data in said.items():
            written = self.file.written(self._as_written([key, name]))
            text = None if written is None else filled(written, self.values, [], as_text=True)
            result[name] = Value.of(data) if text is None else Value(data, text)
        return result

    def error(self, steps: Sequence[Step], message: str, *, key: bool = False) -> DocumentError:
        """Make an error (to raise) about what stands at these steps from the part on; keys may be filled in."""
        return self.file.error(self._as_written(steps), message, key=key)

    def check(self, look: Callable[[T], object], value: T, *steps: Step, key: bool = False) -> None:
        """Call a check and turn its error into one about these steps."""
        try:
            look(value)
        except NameValidationException as error:
            raise self.error(steps, f"'{shown(error.name)}' {error.error_msg}", key=key) from None
        except (RobolinkError, ValueError) as error:
            raise self.error(steps, str(error), key=key) from None

    def _as_written(self, steps: Sequence[Step]) -> list[Step]:
        written = list(self.steps)
        for step in steps:
            written.append(self._renamed.get((*written, step), step))
        return written


class Place(NamedTuple):
    """Where something stands in a part."""

    part: Part
    steps: tuple[Step, ...] = ()

    def error(self, message: str, steps: Sequence[Step] = (), *, key: bool = False) -> DocumentError:
        """Make an error (to raise) about what stands there, or at further steps."""
        return self.part.error((*self.steps, *steps), message, key=key)


def copies(file: LaunchFile, steps: Sequence[Step], data: Mapping[str, Any], values: Values) -> Iterator[Part]:
    """Yield a part as often as its `count` says, with `{i}` for 0, 1, 2 ...; without one, once and without."""
    whole = Part(file, steps, _as_written(file, steps, data), values)
    if "count" not in data:
        yield whole
        return
    for number in range(whole.value("count", Count, 1)):
        yield Part(file, steps, whole.written, values.joined_by({NUMBER: Value.of(number)}))


def _as_ros_spells(key: str, value: Any) -> Any:
    """Read what ROS 2 spells otherwise: log levels in capitals, and `respawn: true` for what is always done."""
    if key == "log_level" and isinstance(value, str):
        return value.lower()
    if key == "respawn" and isinstance(value, bool):
        return "always" if value else "never"
    return value


def _as_written(file: LaunchFile, steps: Sequence[Step], data: Mapping[str, Any]) -> dict[str, Any]:
    """Give a part's data with the texts as they stand where a program gets them."""

    def text(value: Any, *at: Step) -> Any:
        written = file.written([*steps, *at])
        return value if written is None else written

    result = dict(data)
    for key in _AS_WRITTEN:
        value = data.get(key)
        if isinstance(value, list):
            result[key] = [text(each, key, index) for index, each in enumerate(value)]
        elif isinstance(value, dict):
            result[key] = {name: text(each, key, name) for name, each in value.items()}
    return result
