"""Actions of launch descriptions (`launch.actions`)."""

from __future__ import annotations

from collections.abc import Awaitable, Callable, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from robolink.documents.yamlfile import parse
from robolink.exceptions import DocumentError
from robolink.launch.ros.launch.bases import (
    Action,
    BaseEventHandler,
    Event,
    LaunchContext,
    LaunchDescriptionEntity,
    LaunchError,
    SomeSubstitutionsType,
)
from robolink.launch.ros.launch.event_handlers import OnShutdown
from robolink.launch.ros.launch.events import Shutdown as ShutdownEvent
from robolink.launch.ros.launch.inner_names import inner_names
from robolink.launch.ros.launch.lines import Log, LogDebug, LogError, LogInfo, LogWarning
from robolink.launch.ros.launch.processes import ExecuteLocal, ExecuteProcess
from robolink.launch.ros.launch.settings import (
    AppendEnvironmentVariable,
    DeclareBooleanLaunchArgument,
    DeclareLaunchArgument,
    PopEnvironment,
    PopLaunchConfigurations,
    PushEnvironment,
    PushLaunchConfigurations,
    ResetEnvironment,
    ResetLaunchConfigurations,
    SetEnvironmentVariable,
    SetLaunchConfiguration,
    UnsetEnvironmentVariable,
    UnsetLaunchConfiguration,
)
from robolink.launch.ros.launch.sources import IncludeLaunchDescription
from robolink.launch.ros.launch.substitutions import FOR_EACH
from robolink.launch.ros.launch.utilities import (
    LaunchArgumentError,
    normalize_to_list_of_substitutions,
    performed,
)
from robolink.system.terminal import shown

if TYPE_CHECKING:
    import asyncio

__all__ = [
    "AppendEnvironmentVariable",
    "DeclareBooleanLaunchArgument",
    "DeclareLaunchArgument",
    "EmitEvent",
    "ExecuteLocal",
    "ExecuteProcess",
    "ForEach",
    "ForLoop",
    "GroupAction",
    "IncludeLaunchDescription",
    "Log",
    "LogDebug",
    "LogError",
    "LogInfo",
    "LogWarning",
    "OpaqueCoroutine",
    "OpaqueFunction",
    "PopEnvironment",
    "PopLaunchConfigurations",
    "PushEnvironment",
    "PushLaunchConfigurations",
    "RegisterEventHandler",
    "ResetEnvironment",
    "ResetLaunchConfigurations",
    "SetEnvironmentVariable",
    "SetLaunchConfiguration",
    "Shutdown",
    "TimerAction",
    "UnregisterEventHandler",
    "UnsetEnvironmentVariable",
    "UnsetLaunchConfiguration",
]


@inner_names("function", "args", "kwargs")
class OpaqueFunction(Action):
    """Call a function of the launch file, which may return further entities.

    Args:
        function: The function; it gets the context, then `args` and `kwargs`.
        args: Further arguments.
        kwargs: Further arguments by name.
        **left_over_kwargs: `condition`.
    """

    def __init__(
        self,
        *,
        function: Callable[..., Sequence[LaunchDescriptionEntity] | None],
        args: Iterable[Any] | None = None,
        kwargs: Mapping[str, Any] | None = None,
        **left_over_kwargs: Any,
    ) -> None:
        super().__init__(**left_over_kwargs)
        if not callable(function):
            raise LaunchArgumentError(f"OpaqueFunction(function=...) takes a function, got {type(function).__name__}")
        self.function, self.args, self.kwargs = function, list(args or ()), dict(kwargs or {})

    def execute(self, context: LaunchContext) -> Sequence[LaunchDescriptionEntity] | None:
        """Call it with `context`; return what it returns."""
        return self.function(context, *self.args, **self.kwargs)


class OpaqueCoroutine(Action):
    """Run a coroutine of the launch file to its end.

    Args:
        coroutine: Function that makes the coroutine; it gets the context, then `args` and `kwargs`.
        args: Further arguments.
        kwargs: Further arguments by name.
        ignore_context: True leaves the context out.
        **left_over_kwargs: `condition`.
    """

    def __init__(
        self,
        *,
        coroutine: Callable[..., Awaitable[None]],
        args: Iterable[Any] | None = None,
        kwargs: Mapping[str, Any] | None = None,
        ignore_context: bool = False,
        **left_over_kwargs: Any,
    ) -> None:
        super().__init__(**left_over_kwargs)
        self.coroutine, self.args, self.kwargs = coroutine, list(args or ()), dict(kwargs or {})
        self.ignore_context = ignore_context
        self._future: asyncio.Future[None] | None = None

    def execute(self, context: LaunchContext) -> None:
        """Run it with `context`: as a task of the LaunchService, which cancels it when the launch ends.

        `robolink launch` has no loop of asyncio: it waits for the end of the coroutine.
        """
        import asyncio

        first = [] if self.ignore_context else [context]

        async def run() -> None:
            await self.coroutine(*first, *self.args, **self.kwargs)

        if context.asyncio_loop is None:
            asyncio.run(run())
            return
        self._future = future = context.asyncio_loop.create_task(run())

        def cancel(event: Event, context: LaunchContext) -> None:
            future.cancel()

        context.register_event_handler(OnShutdown(on_shutdown=cancel))

    def get_asyncio_future(self) -> asyncio.Future[None] | None:
        """Return its task; None outside of a LaunchService."""
        return self._future


@inner_names(actions="_actions", scoped="_scoped", forwarding="_forwarding", launch_configurations="_configurations")
class GroupAction(Action):
    """Several actions; what they set ends with the group.

    Args:
        actions: The actions.
        scoped: False lets what they set go on behind the group.
        forwarding: False lets them see none of the configurations and variables set before the group.
        launch_configurations: Configurations for the group, by name.
        **left_over_kwargs: `condition`.
    """

    def __init__(
        self,
        actions: Iterable[LaunchDescriptionEntity],
        *,
        scoped: bool = True,
        forwarding: bool = True,
        launch_configurations: Mapping[SomeSubstitutionsType, SomeSubstitutionsType] | None = None,
        **left_over_kwargs: Any,
    ) -> None:
        super().__init__(**left_over_kwargs)
        self._actions = list(actions)
        self._scoped, self._forwarding = scoped, forwarding
        self._configurations = dict(launch_configurations or {})

    def get_sub_entities(self) -> list[LaunchDescriptionEntity]:
        """Return its actions, with those that begin and end the scope."""
        if not self._scoped or self._forwarding:
            own: list[Action] = [SetLaunchConfiguration(name, value) for name, value in self._configurations.items()]
        else:
            own = [ResetEnvironment(), ResetLaunchConfigurations(self._configurations)]
        inside = [*own, *self._actions]
        if not self._scoped:
            return inside
        before, behind = [PushLaunchConfigurations(), PushEnvironment()], [PopEnvironment(), PopLaunchConfigurations()]
        return [*before, *inside, *behind]

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity]:
        """Return its actions."""
        return self.get_sub_entities()


MOST = 10_000
"""Most repetitions."""
LONGEST_NUMBER = 100
"""Longest text of a number of repetitions, in characters."""
_LENGTH = "the length of a loop is a number from 0 on"
Function = Callable[..., Iterable[LaunchDescriptionEntity] | None]


class ForEach(Action):
    """Entities for each of several mappings.

    Args:
        input_values: Text with the mappings in YAML, parted by semicolons: ``{name: ada, x: 1.0}; {name: bob}``.
        function: Function that gets the values of a mapping by their names, and returns entities.
        **kwargs: `condition`.
    """

    def __init__(self, input_values: SomeSubstitutionsType, *, function: Function, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.input_values, self.function = normalize_to_list_of_substitutions(input_values), _checked(function)

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity]:
        """Return the entities for the values in `context`. Raises LaunchError for what is not a mapping."""
        texts = [each for each in performed(context, self.input_values).split(";") if each.strip()]
        _check_count(len(texts))
        return [each for text in texts for each in self.function(**_mapping(text)) or ()]


class ForLoop(Action):
    """Entities for each of the numbers 0, 1, 2 and so on.

    Args:
        length: How many numbers.
        function: Function that gets a number, `i`, and returns entities.
        name: Name of the number for people.
        **kwargs: `condition`.
    """

    def __init__(
        self,
        length: int | SomeSubstitutionsType,
        *,
        function: Function,
        name: SomeSubstitutionsType | None = None,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self.length, self.function, self.name = length, _checked(function), name

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity]:
        """Return the entities for the length in `context`. Raises LaunchError for a length that is not a number."""
        length = self.length if isinstance(self.length, int) else _length(performed(context, self.length))
        if length < 0:
            raise LaunchError(f"{_LENGTH}, got one below")
        _check_count(length)
        return [each for number in range(length) for each in self.function(number) or ()]


class Iteration(Action):
    """Actions of one iteration of a loop in XML or YAML.

    Args:
        actions: The actions.
        values: Values of the iteration, which ForEachVar and ForLoopIndex read.
    """

    def __init__(self, actions: Iterable[LaunchDescriptionEntity], values: Mapping[str, Any]) -> None:
        super().__init__()
        self._actions, self._values = list(actions), dict(values)

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity]:
        """Set the values as locals of `context`; return the actions, and what removes the values behind them."""
        context._push_locals()
        context.extend_locals({FOR_EACH + name: str(value) for name, value in self._values.items()})
        return [*self._actions, _IterationEnd()]


class _IterationEnd(Action):
    """Remove the values of an iteration."""

    def execute(self, context: LaunchContext) -> None:
        context._pop_locals()


def _checked(function: Function) -> Function:
    if not callable(function):
        raise LaunchArgumentError(f"function takes a function, got {type(function).__name__}")
    return function


def _length(text: str) -> int:
    """Return the number that a text spells as Python does, as in ROS 2: ` 5 `, `+5`, `1_000` and `05` are numbers."""
    text = text.strip()
    try:
        if len(text) <= LONGEST_NUMBER:  # a million digits would take their time
            return int(text)
    except ValueError:
        pass
    raise LaunchError(f"{_LENGTH}, got '{shown(text, 60)}'")


def _check_count(count: int) -> None:
    if count > MOST:
        raise LaunchError(f"more than {MOST:,} repetitions")


def _mapping(text: str) -> dict[str, Any]:
    try:
        found = parse(text, name="")
    except DocumentError as error:
        raise LaunchError(f"'{shown(text.strip(), 60)}' is not YAML: {error.message}") from None
    if not isinstance(found, dict):
        raise LaunchError(f"a mapping such as {{name: ada}} is expected, got '{shown(text.strip(), 60)}'")
    return found


@inner_names("period", "actions")
class TimerAction(Action):
    """Actions for later.

    Args:
        period: Time until then, in seconds.
        actions: The actions.
        cancel_on_shutdown: False lets a LaunchService wait for it when it ends. `robolink launch` starts nothing then.
        **kwargs: `condition`.
    """

    lasts = True

    def __init__(
        self,
        *,
        period: float | SomeSubstitutionsType,
        actions: Iterable[LaunchDescriptionEntity],
        cancel_on_shutdown: bool | SomeSubstitutionsType = True,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self.period, self.actions = period, list(actions)
        self.cancel_on_shutdown = cancel_on_shutdown
        self.is_canceled = False
        self._completed: asyncio.Future[None] | None = None

    def execute(self, context: LaunchContext) -> None:
        """Leave it to the launcher, which sees all actions that are executed in `context`."""
        if context.asyncio_loop is not None:
            self._completed = context.asyncio_loop.create_future()
        context.note_executed(self)

    def get_asyncio_future(self) -> asyncio.Future[None] | None:
        """Return the future of its end; None outside of a LaunchService."""
        return self._completed

    def complete(self) -> None:
        """Note that its time has come, or that it was canceled."""
        if self._completed is not None and not self._completed.done():
            self._completed.set_result(None)

    def seconds(self, context: LaunchContext) -> float:
        """Return the period with the values of `context`; raises LaunchError for one that is not a time."""
        text = str(self.period) if isinstance(self.period, (int, float)) else performed(context, self.period)
        try:
            seconds = float(text)
        except ValueError:
            raise LaunchError(f"a timer's period is a number of seconds, got '{text:.60}'") from None
        if not 0.0 <= seconds < 1e9:
            raise LaunchError(f"a timer's period is a number of seconds from 0 on, got {text:.60}")
        return seconds

    def cancel(self) -> None:
        """Let it do nothing when its time comes."""
        self.is_canceled = True
        self.complete()

    def describe_sub_entities(self) -> list[LaunchDescriptionEntity]:
        """Return nothing: its actions come later."""
        return []

    def describe_conditional_sub_entities(self) -> list[tuple[str, Iterable[LaunchDescriptionEntity]]]:
        """Return its actions."""
        return [(f"after {self.period} s", self.actions)]


@inner_names("event_handler")
class RegisterEventHandler(Action):
    """React to events from here on.

    Args:
        event_handler: The reaction.
        **kwargs: `condition`.
    """

    def __init__(self, event_handler: BaseEventHandler, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.event_handler = event_handler

    def execute(self, context: LaunchContext) -> None:
        """Register the handler in `context`."""
        context.register_event_handler(self.event_handler)

    def describe_conditional_sub_entities(self) -> list[tuple[str, Iterable[LaunchDescriptionEntity]]]:
        """Return the entities that follow the event, as far as they are known."""
        return [self.event_handler.describe()]


class UnregisterEventHandler(Action):
    """React no longer.

    Args:
        event_handler: The reaction.
        **kwargs: `condition`.
    """

    def __init__(self, event_handler: BaseEventHandler, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.event_handler = event_handler

    def execute(self, context: LaunchContext) -> None:
        """Remove the handler from `context`."""
        context.unregister_event_handler(self.event_handler)


@inner_names("event")
class EmitEvent(Action):
    """Emit an event.

    Args:
        event: The event.
        **kwargs: `condition`.
    """

    def __init__(self, *, event: Event, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.event = event

    def execute(self, context: LaunchContext) -> None:
        """Emit it in `context`."""
        context.emit_event_sync(self.event)


class Shutdown(EmitEvent):
    """End the launch.

    Args:
        reason: Reason for people.
        **kwargs: `condition`; robolink ignores the event and the context that a handler would pass.
    """

    def __init__(self, *, reason: str = "reason not given", **kwargs: Any) -> None:
        super().__init__(event=ShutdownEvent(reason=reason), **kwargs)
