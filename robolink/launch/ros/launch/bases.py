"""Base classes of ROS 2's launch descriptions: entities, actions, conditions, events, and the context of a launch."""

from __future__ import annotations

import os
import sys
from collections import deque
from collections.abc import Callable, Iterable, Mapping, MutableMapping, Sequence
from pathlib import Path
from types import FrameType
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

from robolink.exceptions import RobolinkError, nearest
from robolink.launch.ros.launch.inner_names import inner_names
from robolink.launch.ros.launch.registry import registered

if TYPE_CHECKING:
    import asyncio

_COMPANIONS = str(Path(__file__).parents[1]) + os.sep
"""Folder of the companions, whose frames are not the user's."""
_OWN = str(Path(__file__).parents[2]) + os.sep

SCOPED = ("launch_configurations", "environment")


class LaunchError(RobolinkError, RuntimeError):
    """A launch file cannot be carried out; the text has the reason in one line."""


class SubstitutionFailure(LaunchError):  # noqa: N818 - ROS 2's name
    """A substitution has no value; the text has the reason."""


class LaunchArgumentError(LaunchError, TypeError):
    """An argument of an action or a substitution has the wrong type, or there is none of its name."""


class Place(NamedTuple):
    """Place in the user's own file at which an action was made.

    Args:
        file: Path of the file; empty if unknown.
        line: Line, from 1; 0 if unknown.
    """

    file: str = ""
    line: int = 0


def calling_place() -> Place:
    """Return the place of the nearest frame outside of this room: where the user's file makes an action.

    It is unknown for an action that robolink itself makes.
    """
    frame: FrameType | None = sys._getframe(1)
    while frame is not None and frame.f_code.co_filename.startswith(_COMPANIONS):
        frame = frame.f_back
    is_own = frame is None or frame.f_code.co_filename.startswith(_OWN)
    return Place() if frame is None or is_own else Place(frame.f_code.co_filename, frame.f_lineno)


class Substitution:
    """Text that is known only when the launch runs; subclasses override `perform`."""

    def describe(self) -> str:
        """Return a description for people."""
        return f"{type(self).__name__}({', '.join(map(described, vars(self).values()))})"

    def perform(self, context: LaunchContext) -> str:
        """Return the text, with the values of `context`."""
        raise NotImplementedError(f"{type(self).__name__} has no perform()")


def described(value: Any) -> str:
    """Return a description for people of a `value` that a substitution has, which may be made of others."""
    if isinstance(value, Substitution):
        return value.describe()
    if isinstance(value, list) and value and all(isinstance(each, Substitution) for each in value):
        return " + ".join(each.describe() for each in value)
    return f"[{', '.join(map(described, value))}]" if isinstance(value, list) else repr(value)


SomeSubstitutionsType: TypeAlias = str | os.PathLike[str] | Substitution | Iterable[str | Substitution]
"""Text, substitution, or several of these, which are joined."""
SomeSubstitutionsType_types_tuple = (str, Path, Substitution, Iterable)
"""The same for `isinstance`."""


class LaunchDescriptionEntity:
    """Anything that stands in a launch description."""

    def describe(self) -> str:
        """Return a description for people."""
        raise NotImplementedError(f"{type(self).__name__} has no describe()")

    def describe_sub_entities(self) -> list[LaunchDescriptionEntity]:
        """Return the entities inside that are visited in any case."""
        return []

    def describe_conditional_sub_entities(self) -> list[tuple[str, Iterable[LaunchDescriptionEntity]]]:
        """Return the entities inside that a condition may leave out, each list with the condition in words."""
        return []

    def visit(self, context: LaunchContext) -> Sequence[LaunchDescriptionEntity] | None:
        """Carry out this entity in `context`; return the entities that come next, None for none."""
        return None

    def get_asyncio_future(self) -> asyncio.Future[Any] | None:
        """Return the future of its end, for which a LaunchService waits; None if it has none."""
        return None


class Condition:
    """Decision on an action.

    Args:
        predicate: Function of the context that decides; None decides against it.
    """

    def __init__(self, *, predicate: Callable[[LaunchContext], bool] | None = None) -> None:
        self._predicate = predicate

    def describe(self) -> str:
        """Return a description for people."""
        return type(self).__name__

    def evaluate(self, context: LaunchContext) -> bool:
        """Return the decision with the values of `context`."""
        return False if self._predicate is None else self._predicate(context)


@inner_names(condition="_condition")
class Action(LaunchDescriptionEntity):
    """Something to do; subclasses override `execute`.

    Args:
        condition: Condition without which it is left out; None has none.
        **unknown: Refused: raises LaunchArgumentError with the nearest name that there is.
    """

    lasts = False
    """True if it is done only later, as a process is when it has ended; it then notes itself when it is executed."""

    def __init__(self, *, condition: Condition | None = None, **unknown: Any) -> None:
        for name in unknown:
            raise no_argument(type(self), name)
        self._condition = condition
        self.place = calling_place()
        """Place of the user's own file that made it."""

    @classmethod
    def parse(cls, entity: Any, parser: Any, ignore: Sequence[str] = ()) -> tuple[Any, dict[str, Any]]:
        """Return this class, and the arguments for an object of it that an element of XML or YAML has.

        A class of one's own that is exposed (`launch.frontend.expose_action`) adds its own ones to those of its base.

        Args:
            entity: The element (`launch.frontend.Entity`).
            parser: Parser of its texts, and of the elements in it.
            ignore: Attributes that are not read here.
        """
        return cls, registered("arguments")(cls, entity, parser, ignore)

    @property
    def condition(self) -> Condition | None:
        """The condition, None if there is none."""
        return getattr(self, "_condition", None)

    def describe(self) -> str:
        """Return a description for people."""
        return type(self).__name__

    def get_sub_entities(self) -> list[LaunchDescriptionEntity]:
        """Return the entities that it brings along."""
        return []

    def describe_sub_entities(self) -> list[LaunchDescriptionEntity]:
        """Return the entities inside that are visited in any case."""
        return self.get_sub_entities() if self.condition is None else []

    def describe_conditional_sub_entities(self) -> list[tuple[str, Iterable[LaunchDescriptionEntity]]]:
        """Return the entities inside that the condition may leave out."""
        return [] if self.condition is None else [(self.condition.describe(), self.get_sub_entities())]

    def visit(self, context: LaunchContext) -> Sequence[LaunchDescriptionEntity] | None:
        """Execute the action in `context` unless its condition is against it."""
        if self.condition is not None and not self.condition.evaluate(context):
            return None
        if not self.lasts:
            context.note_executed(self)
        try:
            return self.execute(context)
        finally:
            if not self.lasts:
                self._note_completion(context)

    def _note_completion(self, context: LaunchContext) -> None:
        future = None if context.asyncio_loop is None else self.get_asyncio_future()
        if future is None:
            context.completed(self)
        else:
            future.add_done_callback(lambda _: context.completed(self))

    def execute(self, context: LaunchContext) -> Sequence[LaunchDescriptionEntity] | None:
        """Do it in `context`; return the entities that come next, None for none."""
        return None


def no_argument(cls: type, name: str) -> LaunchArgumentError:
    """Return the error that `cls` takes no argument `name`, with the nearest one that it takes."""
    import inspect

    known = [
        each.name
        for base in cls.__mro__
        if "__init__" in vars(base)
        for each in inspect.signature(base.__init__).parameters.values()  # type: ignore[misc]
        if each.kind is each.KEYWORD_ONLY or each.kind is each.POSITIONAL_OR_KEYWORD
    ]
    known += getattr(cls, "accepted", ())
    return LaunchArgumentError(f"{cls.__name__} has no argument '{name}'{nearest(name, known)}")


SomeEntitiesType: TypeAlias = LaunchDescriptionEntity | Iterable[LaunchDescriptionEntity]
SomeEntitiesType_types_tuple = (LaunchDescriptionEntity, Iterable)
"""The same for `isinstance`."""
SomeActionsType = SomeEntitiesType


class Event:
    """Something that has happened, or that is requested."""

    name = "launch.Event"


class BaseEventHandler:
    """Reaction to events.

    Args:
        matcher: Function that decides whether an event is meant.
        handle_once: True ends the reaction with the first event.
    """

    def __init__(self, *, matcher: Callable[[Event], bool], handle_once: bool = False) -> None:
        self._matcher, self.handle_once = matcher, handle_once
        self.around: dict[str, dict[str, Any]] = {}
        """Values of the context where it was registered."""
        self.place = calling_place()

    @property
    def handler_description(self) -> str:
        """Description of what is done, for people."""
        return type(self).__name__

    @property
    def matcher_description(self) -> str:
        """Description of the events that are meant, for people."""
        return ""

    def describe(self) -> tuple[str, list[LaunchDescriptionEntity]]:
        """Return a description for people, and the entities that follow an event, as far as they are known."""
        return type(self).__name__, []

    def matches(self, event: Event) -> bool:
        """Return whether `event` is meant."""
        return self._matcher(event)

    def handle(self, event: Event, context: LaunchContext) -> SomeEntitiesType | None:
        """Return the entities that `event` brings about in `context`, where it is `context.locals.event`."""
        context.extend_locals({"event": event})
        if self.handle_once:
            context.unregister_event_handler(self)
        return None


class EventHandler(BaseEventHandler):
    """Reaction to events by fixed entities.

    Args:
        matcher: Function that decides whether an event is meant.
        entities: What follows the event.
        handle_once: True ends the reaction with the first event.
    """

    def __init__(
        self,
        *,
        matcher: Callable[[Event], bool],
        entities: SomeEntitiesType | None = None,
        handle_once: bool = False,
    ) -> None:
        super().__init__(matcher=matcher, handle_once=handle_once)
        self.entities = entities

    def describe(self) -> tuple[str, list[LaunchDescriptionEntity]]:
        """Return a description for people, and the entities that follow an event."""
        return type(self).__name__, entities_in(self.entities)

    def handle(self, event: Event, context: LaunchContext) -> SomeEntitiesType | None:
        """Return the entities; `event` is `context.locals.event` then."""
        super().handle(event, context)
        return self.entities


def entities_in(some: SomeEntitiesType | None) -> list[LaunchDescriptionEntity]:
    """Return one entity, several or none, `some`, as a list."""
    if some is None:
        return []
    return [some] if isinstance(some, LaunchDescriptionEntity) else list(some)


def check_actions(some: Any, where: str) -> None:
    """Raise LaunchArgumentError unless `some` is an action, a description, or several; `where` is for the error."""
    for each in some if isinstance(some, Iterable) and not isinstance(some, str) else [some]:
        if each is not None and not isinstance(each, LaunchDescriptionEntity):
            raise LaunchArgumentError(f"{where} takes actions, got {type(each).__module__}.{type(each).__name__}")


class _Locals:
    """Attributes of `context.locals`: read only."""

    def __init__(self, values: Mapping[str, Any]) -> None:
        self.__dict__.update(values)

    def __getattr__(self, name: str) -> Any:
        raise AttributeError(f"context.locals has no '{name}', only {', '.join(self.__dict__) or 'nothing'}")

    def __setattr__(self, name: str, value: Any) -> None:
        raise AttributeError("context.locals are read-only")


class EventQueue(deque[Event]):
    """Events that were emitted and not handled yet, with the methods of `asyncio.Queue` that wait for nothing."""

    def qsize(self) -> int:
        """Return the number of events."""
        return len(self)

    def empty(self) -> bool:
        """Return whether there is none."""
        return not self

    def put_nowait(self, event: Event) -> None:
        """Add `event`."""
        self.append(event)

    def get_nowait(self) -> Event:
        """Remove and return the first one; raises asyncio.QueueEmpty if there is none."""
        if not self:
            import asyncio

            raise asyncio.QueueEmpty
        return self.popleft()


class Said(str):
    """Line for people.

    Args:
        text: The line.
        severity: Its severity, in the supervisor's words.
    """

    severity: str

    def __new__(cls, text: str, severity: str) -> Said:  # noqa: D102 - the class says it
        made = super().__new__(cls, text)
        made.severity = severity
        return made


class LaunchContext:
    """Values of a running launch: its configurations, its environment, and its event handlers.

    The environment is that of this process, as in ROS 2. For `robolink launch` it is a copy: what a launch file sets
    arrives at its processes, and changes nothing here.

    Args:
        argv: Arguments of the launch, `NAME:=VALUE`.
        noninteractive: True where no terminal is there.
    """

    def __init__(self, *, argv: Iterable[str] | None = None, noninteractive: bool = False) -> None:
        self.argv, self.noninteractive = list(argv or ()), noninteractive
        self.launch_configurations: dict[str, Any] = {}
        self.environment: MutableMapping[str, str] = os.environ
        self.is_shutdown = False
        self.asyncio_loop: asyncio.AbstractEventLoop | None = None
        """Loop of the LaunchService that runs the launch; None where there is none."""
        self.on_change: Callable[[], object] | None = None
        """Called when an event was emitted, or when an action is done; from any thread."""
        self.executed: list[Action] = []
        """Actions executed since the launcher last looked."""
        self.handlers: list[BaseEventHandler] = []
        """Event handlers, the last one registered first."""
        self.finished: list[Action] = []
        """Actions that are done since the launcher last looked; none before there is a handler."""
        self.said: list[str] = []
        """Lines for people since the launcher last looked."""
        self.requested: set[str] = set()
        """Names of the launch configurations that were declared or read."""
        self.emitted = EventQueue()
        """Events that were emitted and not handled yet."""
        self.awaited: list[asyncio.Future[Any]] = []
        """Futures without which a LaunchService is not idle."""
        self.pushed: dict[str, list[dict[str, Any]]] = {each: [] for each in SCOPED}
        """Stacks of the scopes around."""
        self._first_environment = dict(self.environment)
        self._globals: dict[str, Any] = {}
        self._locals: dict[str, Any] = {}
        self._pushed_locals: list[dict[str, Any]] = []

    @property
    def _event_queue(self) -> EventQueue:
        return self.emitted

    @property
    def _event_handlers(self) -> list[BaseEventHandler]:
        return self.handlers

    def _set_asyncio_loop(self, loop: asyncio.AbstractEventLoop | None) -> None:
        self.asyncio_loop = loop

    @property
    def locals(self) -> Any:
        """Values such as `event`, as attributes."""
        return _Locals(self.get_locals_as_dict())

    def get_locals_as_dict(self) -> dict[str, Any]:
        """Return the locals by name."""
        return {**self._globals, **self._locals}

    def extend_locals(self, extensions: Mapping[str, Any]) -> None:
        """Add locals, the mapping `extensions`."""
        self._locals.update(extensions)

    def extend_globals(self, extensions: Mapping[str, Any]) -> None:
        """Add locals, the mapping `extensions`, that give way to others of the same name."""
        self._globals.update(extensions)

    def _push_locals(self) -> None:
        self._pushed_locals.append(dict(self._locals))

    def _pop_locals(self) -> None:
        if not self._pushed_locals:
            raise LaunchError("more scopes of locals end than have begun")
        self._locals = self._pushed_locals.pop()

    def _push_launch_configurations(self) -> None:
        self.push("launch_configurations")

    def _pop_launch_configurations(self) -> None:
        self.pop("launch_configurations")

    def _push_environment(self) -> None:
        self.push("environment")

    def _pop_environment(self) -> None:
        self.pop("environment")

    def push(self, which: str) -> None:
        """Begin a scope of `which`: launch_configurations or environment."""
        values = getattr(self, which)
        self.pushed[which].append({key: list(each) if isinstance(each, list) else each for key, each in values.items()})

    def pop(self, which: str) -> None:
        """End a scope of `which`; raises LaunchError if none was begun."""
        if not self.pushed[which]:
            raise LaunchError(f"more scopes of {which.replace('_', ' ')} end than have begun")
        values = getattr(self, which)
        values.clear()
        values.update(self.pushed[which].pop())

    def reset_environment(self) -> None:
        """Set the environment back to that of the launcher."""
        self.environment.clear()
        self.environment.update(self._first_environment)

    def changed_environment(self) -> dict[str, str | None]:
        """Return the variables that differ from those of the launcher, None for one that was removed."""
        first = self._first_environment
        gone: dict[str, str | None] = {name: None for name in first if name not in self.environment}
        return {**{name: each for name, each in self.environment.items() if first.get(name) != each}, **gone}

    def register_event_handler(self, event_handler: BaseEventHandler, append: bool = False) -> None:
        """Add `event_handler`, before those that are there, or behind them with `append`."""
        event_handler.around = self.snapshot()
        self.handlers.insert(len(self.handlers) if append else 0, event_handler)

    def unregister_event_handler(self, event_handler: BaseEventHandler) -> None:
        """Remove `event_handler`; raises ValueError if it is not there."""
        self.handlers.remove(event_handler)

    def snapshot(self) -> dict[str, dict[str, Any]]:
        """Return a copy of the values that later actions may need: the locals, the configurations, the environment."""
        return {
            "locals": self.get_locals_as_dict(),
            "launch_configurations": dict(self.launch_configurations),
            "environment": dict(self.environment),
        }

    def note_executed(self, action: Action) -> None:
        """Note, for the launcher, that `action` was executed."""
        if not any(each is action for each in self.executed):
            self.executed.append(action)

    def completed(self, action: Action) -> None:
        """Note that `action` is done, if a handler may want to know."""
        if self.handlers:
            self.finished.append(action)
        self._changed()

    def _changed(self) -> None:
        if self.on_change is not None:
            self.on_change()

    def would_handle_event(self, event: Event) -> bool:
        """Return whether a handler means `event`."""
        return any(each.matches(event) for each in self.handlers)

    def emit_event_sync(self, event: Event) -> None:
        """Emit `event`: it is handled once the launcher is done with the present one.

        Raises LaunchArgumentError (a TypeError) for what is not an Event.
        """
        if not isinstance(event, Event):
            raise LaunchArgumentError(f"an event is expected, such as Shutdown(), got {type(event).__name__}")
        self.emitted.append(event)
        self._changed()

    async def emit_event(self, event: Event) -> None:
        """Emit `event`."""
        self.emit_event_sync(event)

    def add_completion_future(self, completion_future: asyncio.Future[Any]) -> None:
        """Let a LaunchService go on until `completion_future` is done; `robolink launch` does not wait for it."""
        self.awaited.append(completion_future)
        self._changed()

    def perform_substitution(self, substitution: Substitution) -> str:
        """Return the text of `substitution`."""
        return substitution.perform(self)
