"""Scoping: the settings that nodes inherit from the groups and includes around them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, NamedTuple, TypeAlias

from robolink.launch.reading.parameters import Given, given_in
from robolink.launch.reading.section import Place, Section
from robolink.validate_namespace import validate_namespace

_SETTINGS = ("process", "respawn", "on_exit", "log_level", "enclave", "cpu")


class Placed(NamedTuple):
    """A value and its place in a file."""

    value: Any
    place: Place


Settings: TypeAlias = "Mapping[str, Placed]"


@dataclass(frozen=True)
class Inherited:
    """Settings in effect at a node: its own and those inherited; the innermost wins.

    `namespace` is '' or begins with a slash. `given` are the parameters of all groups, outermost first.
    """

    namespace: str = ""
    settings: Settings = field(default_factory=dict)
    remappings: Settings = field(default_factory=dict)
    env: Settings = field(default_factory=dict)
    given: tuple[Given, ...] = ()
    awaited: tuple[Placed, ...] = ()

    def within(self, section: Section, said: Any, home: Path | None) -> Inherited:
        """Return the settings within a group; `said` are the group's own keys as a Struct."""
        own = given_in(section, home) if "parameters" in section else []
        inner = self.moved_to(self.inside(section, said.namespace))
        return replace(self._with(section, said, inner), given=(*self.given, *own))

    def with_node(self, section: Section, said: Any) -> Inherited:
        """Return the settings of a node, without its parameters."""
        return self._with(section, said, self)

    def _with(self, section: Section, said: Any, whose: Inherited) -> Inherited:
        """Return the settings with those of a section added; its `process` is in the namespace of `whose`."""
        own = {key: Placed(getattr(said, key), Place(section, (key,))) for key in _SETTINGS if key in section}
        if said.process:
            name = said.process if said.process.startswith("/") else f"{whose.namespace}/{said.process}"
            own["process"] = Placed(name.removeprefix("/"), Place(section, ("process",)))
        return Inherited(
            self.inside(section, said.namespace),
            {**self.settings, **own},
            {**_placed(section, "remappings", said.remappings), **_missing(self.remappings, said.remappings)},
            {**self.env, **_placed(section, "env", said.env)},
            self.given,
            (*self.awaited, *_awaited(section, said.start_after)),
        )

    def moved_to(self, namespace: str) -> Inherited:
        """Return the same settings in another namespace."""
        return replace(self, namespace=namespace)

    def inside(self, section: Section, namespace: str) -> str:
        """Join the namespace of a section to the enclosing ones; one with a slash in front is absolute."""
        if not namespace:
            return self.namespace
        whole = namespace if namespace.startswith("/") else f"{self.namespace}/{namespace}"
        section.check(validate_namespace, namespace if namespace.startswith("/") else f"/{namespace}", "namespace")
        return "" if whole == "/" else whole


def _placed(section: Section, key: str, said: Mapping[str, Any]) -> dict[str, Placed]:
    return {name: Placed(value, Place(section, (key, name))) for name, value in said.items()}


def _missing(outer: Settings, own: Mapping[str, Any]) -> dict[str, Placed]:
    return {name: each for name, each in outer.items() if name not in own}


def _awaited(section: Section, said: Any) -> list[Placed]:
    if isinstance(said, list):
        return [Placed(each, Place(section, ("start_after", index))) for index, each in enumerate(said)]
    return [Placed(said, Place(section, ("start_after",)))]
