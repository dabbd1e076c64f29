"""Fixtures of launch_pytest: descriptions of launches, and the service, the context and the loop that they run with."""

from __future__ import annotations

import asyncio
import sys
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any, NamedTuple

import pytest

from robolink.launch.ros.launch import LaunchService

if TYPE_CHECKING:
    from robolink.launch.ros.launch.bases import LaunchContext

__all__ = ["fixture"]

SCOPES = ("function", "class", "module", "package", "session")
"""Scopes of fixtures, the narrowest first."""
_OPTIONS = "_launch_pytest_options"
_OWN_SCOPE = "_launch_pytest_scope"


class Options(NamedTuple):
    """Options of a fixture that describes a launch.

    Args:
        name: Name of the fixture.
        scope: Its scope.
        shutdown_when_idle: True ends the launch when nothing is left to do.
        auto_shutdown: True ends it when its tests have run; else the description has to.
    """

    name: str
    scope: str
    shutdown_when_idle: bool
    auto_shutdown: bool


def options_of(function: object) -> Options | None:
    """Return the options of a fixture, or of its `function`; None for any other than those that describe a launch."""
    found: Options | None = getattr(function, _OPTIONS, None)
    return found


def fixture(
    decorated: Callable[..., Any] | None = None,
    *args: Any,
    shutdown_when_idle: bool = True,
    auto_shutdown: bool = True,
    **kwargs: Any,
) -> Any:
    """Return a fixture of pytest that describes a launch, or a decorator that makes one.

    The function returns a LaunchDescription, or a sequence that begins with one. In the module that calls this the
    fixtures launch_service, launch_context and event_loop get the same scope, unless it has fixtures of these names.

    Args:
        decorated: The function; None returns a decorator.
        *args: Those of `pytest.fixture`.
        shutdown_when_idle: True ends the launch when nothing is left to do.
        auto_shutdown: True ends it when its tests have run; else the description has to.
        **kwargs: Those of `pytest.fixture`.
    """
    scope = kwargs.get("scope", SCOPES[0])
    if scope in SCOPES[1:]:
        _widen(sys._getframe(1).f_globals, scope)

    def decorate(function: Callable[..., Any]) -> Any:
        name = kwargs.get("name") or function.__name__
        setattr(function, _OPTIONS, Options(name, scope, shutdown_when_idle, auto_shutdown))  # the fixture has it, too
        return pytest.fixture(*args, **kwargs)(function)

    return decorate if decorated is None else decorate(decorated)


def _widen(module: dict[str, Any], scope: str) -> None:
    """Put the fixtures that a launch needs into a module with at least this scope."""
    for name, make in MAKERS.items():
        own = getattr(module.get(name), _OWN_SCOPE, None)
        if name not in module or (own is not None and SCOPES.index(own) < SCOPES.index(scope)):
            module[name] = make(scope)


def end_launch(service: LaunchService, *, ends_it: bool = True) -> None:
    """Wait for the end of a launch.

    Args:
        service: The launch.
        ends_it: True ends it.

    Raises:
        AssertionError: if it has failed.
    """
    __tracebackhide__ = True
    if ends_it:
        service.shutdown(force_sync=True)
    loop, task = service.event_loop, service.task
    if loop is not None and task is not None and not loop.is_closed():
        code = loop.run_until_complete(task)
        assert code == 0, f"the launch has failed: its exit code is {code}, and its log has the reason"


def _marked(function: Callable[..., Any], scope: Any) -> Any:
    setattr(function, _OWN_SCOPE, scope)
    return pytest.fixture(scope=scope)(function)


def make_event_loop(scope: str) -> Any:
    """Return the fixture event_loop with this `scope`."""

    def event_loop() -> Iterator[asyncio.AbstractEventLoop]:
        """Event loop on which the launch runs, and its asynchronous tests."""
        loop = asyncio.new_event_loop()
        asyncio.set_event_loop(loop)
        yield loop
        loop.run_until_complete(loop.shutdown_asyncgens())
        asyncio.set_event_loop(None)
        loop.close()

    return _marked(event_loop, scope)


def make_launch_service(scope: str) -> Any:
    """Return the fixture launch_service with this `scope`."""

    def launch_service(event_loop: asyncio.AbstractEventLoop) -> Iterator[LaunchService]:
        """Service that runs the launch."""
        service = LaunchService()
        yield service
        end_launch(service)

    return _marked(launch_service, scope)


def make_launch_context(scope: str) -> Any:
    """Return the fixture launch_context with this `scope`."""

    def launch_context(launch_service: LaunchService) -> LaunchContext:
        """Context of the launch."""
        return launch_service.context

    return _marked(launch_context, scope)


MAKERS: dict[str, Callable[[str], Any]] = {
    "event_loop": make_event_loop,
    "launch_service": make_launch_service,
    "launch_context": make_launch_context,
}
"""Makers of the fixtures that a launch needs, by name."""
