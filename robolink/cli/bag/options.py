"""Factories of arguments and flags that the verbs of `robolink bag` share, and what their values mean."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Annotated, Any

import typer

from robolink.cli.shared.options import choice

if TYPE_CHECKING:
    from robolink.bag.selection import Selection
    from robolink.qos import QoSProfile

STORAGES = ["mcap", "sqlite3"]


def names(*flags: str, help: str, metavar: str = "NAME...", completion: Any = None) -> Any:  # noqa: A002 - typer's word
    """Return an option that takes several names."""
    return typer.Option(*flags, metavar=metavar, help=help, autocompletion=completion)


def flag(*flags: str, help: str) -> Any:  # noqa: A002
    """Return an option that takes no value."""
    return typer.Option(*flags, help=help)


def file(*flags: str, help: str) -> Any:  # noqa: A002
    """Return an option that takes a file."""
    return typer.Option(*flags, metavar="FILE", help=help)


KnownStorage = Annotated[
    str, choice("--storage", STORAGES, "Storage plugin of the bag; detected by default", short="-s")
]
Overrides = Annotated[str, file("--qos-profile-overrides-path", help="YAML file with QoS profiles by topic.")]
NoKeys = Annotated[bool, flag("--disable-keyboard-controls", help="Disable the keyboard controls.")]
LogLevel = Annotated[str, choice("--log-level", ["debug", "info", "warn", "error", "fatal"], "Log level")]


def overrides(path: str) -> Mapping[str, QoSProfile]:
    """Return the profiles of the file behind `--qos-profile-overrides-path`; none for ''."""
    if not path:
        return {}
    from robolink.bag.qos import read_qos_overrides

    return read_qos_overrides(path)


def full(name: str) -> str:
    """Return the full name of a topic of a bag, whose slash people leave out."""
    return name if name.startswith("/") else f"/{name}"


def selection_of(values: Mapping[str, Any]) -> Selection:
    """Return the topics of a bag that the values of flags mean: everything, unless something is named.

    Args:
        values: Values by the names of the fields of Selection; those that a verb does not have may be missing.
    """
    from robolink.bag.selection import EVERYTHING, Selection

    lists = [name for name, default in Selection._field_defaults.items() if default == ()]
    given: dict[str, Any] = {name: tuple(values.get(name) or ()) for name in lists}
    given |= {name: tuple(map(full, given[name])) for name in lists if not name.endswith("types")}
    given |= {name: values[name] for name in ("regex", "exclude_regex")}
    chosen = any(given[each] for each in ("topics", "topic_types", "services", "actions", "regex"))
    return (Selection(include_hidden=True) if chosen else EVERYTHING)._replace(**given)
