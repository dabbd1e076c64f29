"""pytest plugin of launch_pytest: runs launches for fixtures, and their tests beside them and after them."""

from __future__ import annotations

import asyncio
import functools
import inspect
from collections.abc import Callable, Generator, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import pytest

from robolink.launch.ros.launch import LaunchDescription, LaunchService
from robolink.launch.ros.launch_testing.actions import ReadyToTest
from robolink.launch.ros.launch_testing.loader import LaunchTestError, ready_actions
from robolink.testing.launch_pytest.fixtures import (
    SCOPES,
    Options,
    end_launch,
    make_event_loop,
    make_launch_context,
    make_launch_service,
    options_of,
)

NEEDED = ("launch_service", "event_loop")
"""Fixtures that each test of a launch has, besides the launch."""
_NAME_OF_SECOND = "[shutdown_test]"

event_loop = make_event_loop(SCOPES[0])
launch_service = make_launch_service(SCOPES[0])
launch_context = make_launch_context(SCOPES[0])


class LaunchTestWarning(pytest.PytestWarning):
    """A launch test is not as it should be."""


# --- The launch -------------------------------------------------------------------------------------------------------


@pytest.hookimpl(wrapper=True, tryfirst=True)
def pytest_fixture_setup(fixturedef: Any, request: Any) -> Generator[None, Any, Any]:
    """Begin the launch that a fixture describes, and wait until it is ready for its tests."""
    options = options_of(fixturedef.func)
    if options is None:
        return (yield)
    service, loop = (request.getfixturevalue(each) for each in NEEDED)
    made = yield
    try:
        description = _description(made, options.name)
        request.addfinalizer(functools.partial(end_launch, service, ends_it=options.auto_shutdown))
        _begin(description, service, loop, options)
    except BaseException:
        fixturedef.cached_result = None  # else the next test would have the value without the launch
        raise
    return made


def _description(made: Any, name: str) -> LaunchDescription:
    found = made[0] if isinstance(made, Sequence) and made else made
    if not isinstance(found, LaunchDescription):
        raise LaunchTestError(
            f"the launch_pytest fixture '{name}' must be either a launch description, or a sequence that begins with"
            f" one: it returned {type(made).__name__}"
        )
    return found


def _begin(
    description: LaunchDescription, service: LaunchService, loop: asyncio.AbstractEventLoop, options: Options
) -> None:
    ready = ready_actions(description.entities)
    if len(ready) > 1:
        raise LaunchTestError(
            f"the launch_pytest fixture '{options.name}' must return a LaunchDescription containing only one"
            f" ReadyToTest action: it has {len(ready)}"
        )
    if not ready:
        ready = [ReadyToTest()]
        description.add_action(ready[0])
    is_ready = asyncio.Event()
    ready[0].add_callback(is_ready.set)
    service.include_launch_description(description)

    async def begin() -> None:
        waiting = asyncio.ensure_future(is_ready.wait())
        await asyncio.wait([launch, waiting], return_when=asyncio.FIRST_COMPLETED)
        waiting.cancel()

    launch = loop.create_task(service.run_async(shutdown_when_idle=options.shutdown_when_idle))
    loop.run_until_complete(begin())
    if not is_ready.is_set():
        launch.result()
        raise LaunchTestError(f"the launch of the fixture '{options.name}' has ended before its ReadyToTest action")


# --- Its tests --------------------------------------------------------------------------------------------------------


@dataclass
class Halves:
    """Generator that the first half of a test leaves for the second one; None if the first has failed."""

    rest: Any = None


@dataclass
class Part:
    """Test of a launch, or a half of one.

    Args:
        options: Options of the launch.
        is_after: True if it runs when the launch has ended.
        halves: Of a generator whose launch has several tests what both halves share; None of any other test.
    """

    options: Options
    is_after: bool
    halves: Halves | None = field(default=None)


_PART = pytest.StashKey[Part]()


@pytest.hookimpl(tryfirst=True)
def pytest_pycollect_makeitem(collector: Any, name: str, obj: object) -> list[pytest.Item] | None:
    """Collect a function with the mark `launch`; a generator of a launch with several tests is two tests."""
    if not (inspect.isfunction(obj) and collector.funcnamefilter(name)):
        return None
    mark = next((each for each in getattr(obj, "pytestmark", ()) if each.name == "launch"), None)
    mark = mark or collector.get_closest_marker("launch")
    if mark is None:
        return None
    described = mark.kwargs.get("fixture")
    options = options_of(described)
    if options is None:
        return [_skipped(collector, name, described)]
    pytest.mark.usefixtures(options.name, *NEEDED)(obj)
    is_after = bool(mark.kwargs.get("shutdown", False))
    items: list[pytest.Item] = list(collector._genfunctions(name, obj))
    for each in items:
        each.stash[_PART] = Part(options, is_after)
    if _has_halves(obj) and options.scope != SCOPES[0] and not is_after:
        items += _second_halves(items, list(collector._genfunctions(name, obj)), options)
    return items


def _skipped(collector: Any, name: str, described: object) -> pytest.Item:
    got = "there is none" if described is None else f"it is no @launch_pytest.fixture but {type(described).__name__}"
    text = f'a "fixture" keyword argument is required in pytest.mark.launch(): {got}'
    item: pytest.Item = pytest.Function.from_parent(collector, name=name)
    item.warn(LaunchTestWarning(text))
    item.add_marker(pytest.mark.skip(text))
    return item


def _has_halves(function: object) -> bool:
    return inspect.isgeneratorfunction(function) or inspect.isasyncgenfunction(function)


def _second_halves(firsts: Iterable[pytest.Item], seconds: list[Any], options: Options) -> list[pytest.Item]:
    """Return the tests that go on where generators have stopped."""
    for first, second in zip(firsts, seconds, strict=True):
        halves = first.stash[_PART].halves = Halves()
        second.stash[_PART] = Part(options, is_after=True, halves=halves)
        second.name += _NAME_OF_SECOND
        known, needed = second._fixtureinfo, (options.name, *NEEDED)
        # It gets nothing, and must not let its arguments be made once more.
        second.fixturenames = [each for each in known.initialnames if each not in known.argnames or each in needed]
    return seconds


@pytest.hookimpl(trylast=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Move the tests of after a launch behind all others of the same launch."""
    last = {_launch_of(each): at for at, each in enumerate(items) if not _is_after(each)}
    waiting: dict[object, list[pytest.Item]] = {}
    ordered: list[pytest.Item] = []
    for at, each in enumerate(items):
        launch = _launch_of(each)
        if launch is not None and _is_after(each) and last.get(launch, -1) > at:
            waiting.setdefault(launch, []).append(each)
            continue
        ordered.append(each)
        if launch is not None and last.get(launch) == at:
            ordered += waiting.pop(launch, [])
    items[:] = ordered


def _is_after(item: pytest.Item) -> bool:
    part = item.stash.get(_PART, None)
    return part is not None and part.is_after


def _launch_of(item: Any) -> object:
    """Return a key for the launch that a test shares with others; None for one that it shares with none."""
    part = item.stash.get(_PART, None)
    if part is None or part.options.scope == SCOPES[0]:
        return None
    places = {"class": item.cls, "module": item.module}
    callspec = getattr(item, "callspec", None)
    case = None if callspec is None else callspec.indices.get(part.options.name)
    return (part.options, places.get(part.options.scope), case)


@pytest.hookimpl(tryfirst=True)
def pytest_pyfunc_call(pyfuncitem: Any) -> bool | None:
    """Run the test of a launch: a coroutine on the loop of the launch, a function on a thread beside it."""
    __tracebackhide__ = True
    part = pyfuncitem.stash.get(_PART, None)
    if part is None:
        return None
    service, loop = (pyfuncitem.funcargs[each] for each in NEEDED)
    end = functools.partial(end_launch, service, ends_it=part.options.auto_shutdown)
    function = pyfuncitem.obj
    if part.is_after and part.halves is None and _has_halves(function):
        text = "a generator or async generator is a launch test without shutdown=True: it has a part for that"
        pytest.fail(text, pytrace=False)
    if part.is_after:
        end()
    if part.is_after and part.halves is not None:
        if part.halves.rest is None:
            pytest.skip("the first half of this test has failed")
        _finish(part.halves.rest, loop)
        return True
    arguments = {name: pyfuncitem.funcargs[name] for name in pyfuncitem._fixtureinfo.argnames}
    if not _has_halves(function):
        _run(function, arguments, loop)
        return True
    generator = function(**arguments)
    goes_on = _step(generator, loop)
    if part.halves is not None:
        part.halves.rest = generator if goes_on else ()
    elif goes_on:
        end()
        _finish(generator, loop)
    return True


def _run(function: Callable[..., Any], arguments: Mapping[str, Any], loop: asyncio.AbstractEventLoop) -> None:
    __tracebackhide__ = True
    if inspect.iscoroutinefunction(function):
        loop.run_until_complete(function(**arguments))
    else:
        loop.run_until_complete(loop.run_in_executor(None, functools.partial(function, **arguments)))


def _step(generator: Any, loop: asyncio.AbstractEventLoop) -> bool:
    """Let a generator go on to its next `yield`; return whether it has come to one."""
    __tracebackhide__ = True

    async def step() -> bool:
        try:
            await generator.__anext__()
        except StopAsyncIteration:
            return False
        return True

    def step_sync() -> bool:
        try:
            next(generator)
        except StopIteration:
            return False
        return True

    if inspect.isasyncgen(generator):
        return loop.run_until_complete(step())
    return loop.run_until_complete(loop.run_in_executor(None, step_sync))


def _finish(generator: Any, loop: asyncio.AbstractEventLoop) -> None:
    __tracebackhide__ = True
    if generator != () and _step(generator, loop):
        pytest.fail("a launch test that is a generator must stop iteration after yielding once", pytrace=False)
