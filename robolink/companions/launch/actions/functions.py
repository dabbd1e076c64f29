"""Actions that run functions of the launch file, or write a line."""

from __future__ import annotations

from collections.abc import Awaitable, Callable, Iterable, Mapping, Sequence
from typing import Any

from robolink.companions.launch.bases import Action, LaunchContext, LaunchDescriptionEntity, SomeSubstitutionsType
from robolink.companions.launch.utilities import (
    LaunchArgumentError,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)


class LogInfo(Action):
    """Write a line.

    Args:
        msg: The text.
        **kwargs: `condition`.
    """

    def __init__(self, *, msg: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.msg = normalize_to_list_of_substitutions(msg)

    def execute(self, context: LaunchContext) -> None:
        """Write it as a line of the launcher's own, with the values of `context`."""
        context.said.append(perform_substitutions(context, self.msg))


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

    def execute(self, context: LaunchContext) -> None:
        """Run it with `context`; the launch waits for it, since robolink's launcher has no loop of asyncio."""
        import asyncio

        first = [] if self.ignore_context else [context]

        async def run() -> None:
            await self.coroutine(*first, *self.args, **self.kwargs)

        asyncio.run(run())
