"""What groups and includes hand down to the nodes within them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, NamedTuple, TypeAlias

from robolink.launch.reading.parameters import Given, given_in
from robolink.launch.reading.part import Part, Place
from robolink.validate_namespace import validate_namespace

_SETTINGS = ("process", "respawn", "on_exit", "log_level", "cpu")


class Placed(NamedTuple):
    """Something that is said, and where."""

    value: Any
    place: Place


Settings: TypeAlias = "Mapping[str, Placed]"


@dataclass(frozen=True)
class Around:
    """All that is said around a node, and by the node itself: the nearer counts.

    `namespace` is '' or begins with a slash. `given` are the parameters of all groups, outermost first.
    """

    namespace: str = ""
    settings: Settings = field(default_factory=dict)
    remappings: Settings = field(default_factory=dict)
    env: Settings = field(default_factory=dict)
    given: tuple[Given, ...] = ()
    awaited: tuple[Placed, ...] = ()

    def within(self, part: Part, said: Any, home: Path | None) -> Around:
        """Give what holds within a group, of which `said` is what it says as a Struct."""
        own = given_in(part, home) if "parameters" in part else []
        inner = self.moved_to(self.inside(part, said.namespace))
        return replace(self._with(part, said, inner), given=(*self.given, *own))

    def with_node(self, part: Part, said: Any) -> Around:
        """Give what holds for a node, but for its parameters."""
        return self._with(part, said, self)

    def _with(self, part: Part, said: Any, whose: Around) -> Around:
        """Give what holds with what is said in a part; `whose` namespace its process belongs to."""
        own = {key: Placed(getattr(said, key), Place(part, (key,))) for key in _SETTINGS if key in part}
        if said.process:
            name = said.process if said.process.startswith("/") else f"{whose.namespace}/{said.process}"
            own["process"] = Placed(name.removeprefix("/"), Place(part, ("process",)))
        return Around(
            self.inside(part, said.namespace),
            {**self.settings, **own},
            {**_placed(part, "remappings", said.remappings), **_missing(self.remappings, said.remappings)},
            {**self.env, **_placed(part, "env", said.env)},
            self.given,
            (*self.awaited, *_awaited(part, said.start_after)),
        )

    def moved_to(self, namespace: str) -> Around:
        """Give the same in another namespace."""
        return replace(self, namespace=namespace)

    def inside(self, part: Part, namespace: str) -> str:
        """Join a namespace that a part says to those around it; one with a slash in front stands for itself."""
        if not namespace:
            return self.namespace
        whole = namespace if namespace.startswith("/") else f"{self.namespace}/{namespace}"
        part.check(validate_namespace, namespace if namespace.startswith("/") else f"/{namespace}", "namespace")
        return "" if whole == "/" else whole


def _placed(part: Part, key: str, said: Mapping[str, Any]) -> dict[str, Placed]:
    return {name: Placed(value, Place(part, (key, name))) for name, value in said.items()}


def _missing(outer: Settings, own: Mapping[str, Any]) -> dict[str, Placed]:
    return {name: each for name, each in outer.items() if name not in own}


def _awaited(part: Part, said: Any) -> list[Placed]:
    if isinstance(said, list):
        return [Placed(each, Place(part, ("start_after", index))) for index, each in enumerate(said)]
    return [Placed(said, Place(part, ("start_after",)))]
