"""Futures and tasks: results, exceptions, cancelling, awaiting; in an executor and in asyncio."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Generator
from typing import Any

import pytest

from robolink import Future
from robolink.executors import SingleThreadedExecutor
from robolink.task import Task


def test_a_future_has_its_result_once_it_is_set() -> None:
    future: Future[int] = Future()
    assert not future.done()
    assert future.result() is None
    future.set_result(3)
    assert future.done()
    assert not future.cancelled()
    assert future.result() == 3
    assert future.exception() is None


def test_a_future_raises_its_exception() -> None:
    future: Future[int] = Future()
    error = ValueError("no")
    future.set_exception(error)
    assert future.exception() is error
    with pytest.raises(ValueError, match="no"):
        future.result()


def test_an_exception_that_nobody_asked_for_is_told(capsys: pytest.CaptureFixture[str]) -> None:
    future: Future[int] = Future()
    future.set_exception(ValueError("lost"))
    future.__del__()
    assert capsys.readouterr().err == "The following exception was never retrieved: lost\n"
    assert future.exception() is not None
    future.__del__()
    assert capsys.readouterr().err == ""


def test_whether_a_done_callback_was_there_is_told() -> None:
    future: Future[int] = Future()
    future.add_done_callback(print)
    assert [future.remove_done_callback(print) for _ in range(2)] == [True, False]


def test_cancelling_counts_only_before_the_result() -> None:
    early: Future[int] = Future()
    early.cancel()
    assert early.cancelled()
    assert not early.done()
    late: Future[int] = Future()
    late.set_result(1)
    late.cancel()
    assert not late.cancelled()


def test_callbacks_run_once_whenever_they_are_added() -> None:
    future: Future[int] = Future()
    seen: list[Any] = []

    def removed(_: Future[int]) -> None:
        seen.append("removed")

    future.add_done_callback(lambda done: seen.append(done.result()))
    future.add_done_callback(removed)
    future.remove_done_callback(removed)
    future.set_result(1)
    future.add_done_callback(lambda done: seen.append("late"))
    assert seen == [1, "late"]


def test_a_broken_callback_does_not_break_whoever_sets_the_result() -> None:
    future: Future[int] = Future()
    seen: list[int] = []
    future.add_done_callback(lambda done: 1 // 0)
    future.add_done_callback(lambda done: seen.append(1))
    with pytest.warns(UserWarning, match="Unhandled exception in done callback"):
        future.set_result(1)
    assert seen == [1]


def test_callbacks_run_in_the_executor_if_there_is_one(executor: SingleThreadedExecutor) -> None:
    future = executor.create_future()
    seen: list[Any] = []
    future.add_done_callback(lambda done: seen.append(done.result()))
    future.set_result(1)
    assert seen == []
    executor.spin_once(timeout_sec=0)
    assert seen == [1]


def test_a_waker_is_called_at_once() -> None:
    future: Future[int] = Future()
    woken: list[int] = []
    future.when_done(lambda: woken.append(1))
    future.set_result(0)
    future.when_done(lambda: woken.append(2))
    assert woken == [1, 2]


def test_a_future_can_be_awaited_in_asyncio() -> None:
    async def main() -> int | None:
        future: Future[int] = Future()
        asyncio.get_running_loop().call_soon(future.set_result, 7)
        return await future

    assert asyncio.run(main()) == 7


def test_a_task_runs_a_function() -> None:
    task: Task[int] = Task(lambda a, b: a + b, (1,), {"b": 2})
    task()
    task()
    assert task.done()
    assert task.result() == 3


def test_a_task_keeps_the_exception() -> None:
    task: Task[int] = Task(lambda: 1 // 0)
    task()
    assert isinstance(task.exception(), ZeroDivisionError)


def test_a_coroutine_runs_on_from_await_to_await() -> None:
    first: Future[int] = Future()
    second: Future[int] = Future()

    async def add(start: int) -> int:
        return start + (await first or 0) + (await second or 0)

    task: Task[int] = Task(add, (100,))
    task()
    assert task.awaits is first
    first.set_result(10)
    task()
    assert task.awaits is second
    assert not task.done()
    second.set_result(1)
    task()
    assert task.result() == 111


def test_a_cancelled_coroutine_is_closed() -> None:
    ended: list[str] = []

    async def wait() -> None:
        try:
            await Future()
        finally:
            ended.append("closed")

    task: Task[None] = Task(wait)
    task()
    task.cancel()
    assert ended == ["closed"]
    assert task.cancelled()
    task()
    assert not task.done()


def test_a_task_that_runs_says_so() -> None:
    seen: list[bool] = []
    task: Task[None] = Task(lambda: seen.append(task.executing()))
    task()
    assert seen == [True]
    assert not task.executing()


# Inside asyncio


class Counted:
    """Awaits a future, and counts how often it gives control away."""

    def __init__(self, future: Future[int]) -> None:
        self.future, self.rounds = future, 0

    def __await__(self) -> Generator[Any, None, int | None]:
        steps = self.future.__await__()
        while True:
            try:
                step = next(steps)
            except StopIteration as end:
                return end.value  # type: ignore[no-any-return]
            self.rounds += 1
            yield step


def test_asyncio_sleeps_until_another_thread_sets_the_result() -> None:
    """rclpy's bare yield makes the event loop go round and round."""

    async def main() -> tuple[int | None, int]:
        future: Future[int] = Future()
        counted = Counted(future)
        threading.Timer(0.05, future.set_result, (7,)).start()
        return await counted, counted.rounds

    assert asyncio.run(main()) == (7, 1)


def test_asyncio_may_give_up_waiting() -> None:
    future: Future[int] = Future()

    async def main() -> None:
        with pytest.raises(asyncio.TimeoutError):
            await asyncio.wait_for(_result_of(future), 0.01)

    asyncio.run(main())
    assert future._wakers == []
    future.set_result(1)


def test_a_result_that_comes_after_the_event_loops_end_hurts_nobody() -> None:
    future: Future[int] = Future()
    loop = asyncio.new_event_loop()
    task = loop.create_task(_result_of(future))
    loop.run_until_complete(asyncio.sleep(0))
    wakers = list(future._wakers)
    task.cancel()
    with pytest.raises(asyncio.CancelledError):
        loop.run_until_complete(task)
    loop.close()
    assert len(wakers) == 1
    wakers[0]()
    future.set_result(1)


async def _result_of(future: Future[int]) -> int | None:
    return await future


def test_an_executor_may_spin_inside_asyncio(executor: SingleThreadedExecutor) -> None:
    future: Future[int] = Future()

    async def main() -> object:
        task = executor.create_task(_result_of, future)
        executor.create_task(future.set_result, 5)
        executor.spin_until_future_complete(task, timeout_sec=1.0)
        return task.result()

    assert asyncio.run(main()) == 5


def test_asyncio_may_run_inside_a_task(executor: SingleThreadedExecutor) -> None:
    async def main() -> int | None:
        future: Future[int] = Future()
        threading.Timer(0.01, future.set_result, (9,)).start()
        return await future

    task = executor.create_task(lambda: asyncio.run(main()))
    executor.spin_once()
    assert task.result() == 9


def test_asyncio_sleep_needs_an_event_loop(executor: SingleThreadedExecutor) -> None:
    """As in rclpy: an executor is none. A sleep of 0 only gives way to others."""

    async def callback(seconds: float) -> str:
        await asyncio.sleep(seconds)
        return "slept"

    task = executor.create_task(callback, 0)
    executor.spin_until_future_complete(task, timeout_sec=1.0)
    assert task.result() == "slept"
    executor.create_task(callback, 0.01)
    with pytest.raises(RuntimeError, match="no running event loop"):
        executor.spin_once()
