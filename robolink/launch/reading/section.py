"""A section of a launch file, such as a node or a group, with lazy substitution of `{name}`."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, NamedTuple, TypeVar

from robolink.exceptions import DocumentError, NameValidationException, RobolinkError
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
from robolink.system.terminal import shown

T = TypeVar("T")

_TYPED = ("parameters", "arguments", "count", "if", "unless", "interactive", "cpu", "respawn", "record", "limits")
"""Keys in which `{name}` may become something else than a text."""
_DECIDES = ("if", "unless", "interactive")
"""Keys whose value is a boolean."""
_COLLECTIONS = ("args", "run", "env", "remappings")
"""Keys whose whole value may be one `{name}`; inside their lists and mappings it becomes text."""
_AS_WRITTEN = ("args", "run", "env")
"""Keys that programs get letter by letter: `012`, `1.10` and `true` stay texts there."""


class Section:
    """A mapping in a launch file whose keys are substituted when they are read.

    A key with nothing but a `{name}` that stands for null counts as absent. All methods raise `DocumentError` for
    mistakes in the file.
    """

    def __init__(self, file: LaunchFile, steps: Sequence[Step], written: Mapping[str, Any], values: Values) -> None:
        self.file, self.steps, self.values = file, tuple(steps), values
        self.written = {key: data for key, data in written.items() if key in _DECIDES or not is_null(data, values)}
        self._renamed: Renamed = {}

    def __contains__(self, key: str) -> bool:
        return key in self.written

    def get(self, key: str, default: Any = None) -> Any:
        """Return the value under a key, substituted."""
        if key not in self.written:
            return default
        data, steps = self.written[key], (*self.steps, key)
        is_typed = key in _TYPED or (key in _COLLECTIONS and isinstance(data, str))
        try:
            return _as_ros_spells(key, filled(data, self.values, steps, as_text=not is_typed, renamed=self._renamed))
        except SubstitutionError as error:
            raise self.file.error(error.steps, str(error), key=error.is_key) from None

    def read(self, type_: Any, *, without: Sequence[str] = ()) -> Any:
        """Convert all keys but those of `without` to a Struct."""
        data = {key: self.get(key) for key in self.written if key not in without}
        return self.file.value(data, type_, self.steps)

    def value(self, key: str, type_: Any, default: Any) -> Any:
        """Convert the value of one key to a type."""
        return self.file.value(self.get(key), type_, (*self.steps, key)) if key in self.written else default

    def values_in(self, key: str) -> dict[str, Value]:
        """Return the mapping under a key, each value with the letters it is written with."""
        said: dict[str, Any] = self.get(key, {})
        result = {}
        for name, data in said.items():
            written = self.file.written(self._as_written([key, name]))
            text = None if written is None else filled(written, self.values, [], as_text=True)
            result[name] = Value.of(data) if text is None else Value(data, text)
        return result

    def error(self, steps: Sequence[Step], message: str, *, key: bool = False) -> DocumentError:
        """Return an error (to raise) about the value at these steps below the section; keys may be substituted ones."""
        return self.file.error(self._as_written(steps), message, key=key)

    def check(self, look: Callable[[T], object], value: T, *steps: Step, key: bool = False) -> None:
        """Call a check and convert its error to a `DocumentError` about these steps."""
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
    """Place of a value in a section."""

    section: Section
    steps: tuple[Step, ...] = ()

    def error(self, message: str, steps: Sequence[Step] = (), *, key: bool = False) -> DocumentError:
        """Return an error (to raise) about the value there, or at further steps."""
        return self.section.error((*self.steps, *steps), message, key=key)


def copies(file: LaunchFile, steps: Sequence[Step], data: Mapping[str, Any], values: Values) -> Iterator[Section]:
    """Yield `count` copies of a section, with `{i}` for 0, 1, 2 ...; without a `count`, one copy without `{i}`."""
    whole = Section(file, steps, _as_written(file, steps, data), values)
    if "count" not in data:
        yield whole
        return
    for number in range(whole.value("count", Count, 1)):
        yield Section(file, steps, whole.written, values.joined_by({NUMBER: Value.of(number)}))


def _as_ros_spells(key: str, value: Any) -> Any:
    """Convert ROS 2's spellings: log levels in capitals, and `respawn: true` for `always`."""
    if key == "log_level" and isinstance(value, str):
        return value.lower()
    if key == "respawn" and isinstance(value, bool):
        return "always" if value else "never"
    return value


def _as_written(file: LaunchFile, steps: Sequence[Step], data: Mapping[str, Any]) -> dict[str, Any]:
    """Return a section's data, with the letters as written under the keys that programs get."""

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
