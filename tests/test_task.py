"""Futures and tasks: results, exceptions, cancelling, awaiting; in an executor and in asyncio."""

from __future__ import annotations

import asyncio
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


def test_an_exception_that_nobody_asked_for_is_a_warning() -> None:
    future: Future[int] = Future()
    future.set_exception(ValueError("lost"))
    with pytest.warns(ResourceWarning, match="never retrieved: lost"):
        future.__del__()
    assert future.exception() is not None


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
