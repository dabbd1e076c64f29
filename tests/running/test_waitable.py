"""A program's own waitables: when they are asked, taken and executed, and what they cannot do."""

from __future__ import annotations

import threading
from typing import Any

import pytest

from robolink import Context, Future, Node
from robolink.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from robolink.executors import Executor, MultiThreadedExecutor, SingleThreadedExecutor
from robolink.waitable import NumberOfEntities, Waitable, WaitSet
from tests.support.spins import spin_for, spin_until

PATIENCE = 30.0


class Postbox(Waitable):
    """Executes for each letter that was put into it, in whatever thread."""

    def __init__(self) -> None:
        super().__init__(MutuallyExclusiveCallbackGroup())
        self.letters: list[str] = []
        self.read: list[str] = []
        self.asked = 0

    def add_to_wait_set(self, wait_set: WaitSet) -> None:
        self.asked += 1

    def is_ready(self, wait_set: WaitSet) -> bool:
        return bool(self.letters)

    def take_data(self) -> str:
        return self.letters.pop(0)

    async def execute(self, taken_data: str) -> None:
        self.read.append(taken_data)


@pytest.fixture
def node(virtual: Context, executor: SingleThreadedExecutor) -> Node:
    made = Node("node", context=virtual)
    executor.add_node(made)
    return made


def test_it_is_asked_and_executed(node: Node, executor: SingleThreadedExecutor) -> None:
    postbox = Postbox()
    node.add_waitable(postbox)
    assert list(node.waitables) == [postbox]
    spin_for(executor, 0.1)
    assert postbox.asked > 0
    assert postbox.read == []
    node.create_timer(0.1, lambda: postbox.letters.extend("ab"))
    spin_for(executor, 0.25)
    assert "".join(postbox.read) == "abab"


def test_it_is_asked_no_more_once_removed(node: Node, executor: SingleThreadedExecutor) -> None:
    postbox = Postbox()
    node.add_waitable(postbox)
    postbox.letters.append("a")
    node.remove_waitable(postbox)
    node.remove_waitable(postbox)
    spin_for(executor, 0.1)
    assert (postbox.asked, postbox.read, list(node.waitables)) == (0, [], [])


def test_it_goes_with_its_node(node: Node, executor: SingleThreadedExecutor) -> None:
    postbox = Postbox()
    node.add_waitable(postbox)
    executor.remove_node(node)
    postbox.letters.append("a")
    spin_for(executor, 0.1)
    assert postbox.read == []
    executor.add_node(node)
    spin_for(executor, 0.1)
    assert postbox.read == ["a"]
    node.destroy_node()
    assert list(node.waitables) == []


@pytest.mark.filterwarnings("ignore:a MultiThreadedExecutor with one thread")  # on a machine of one core
@pytest.mark.parametrize("kind", [SingleThreadedExecutor, MultiThreadedExecutor])
def test_another_thread_wakes_the_executor(context: Context, kind: type[Executor]) -> None:
    node, postbox = Node("node", context=context), Postbox()
    node.add_waitable(postbox)
    with kind(context=context) as executor:
        executor.add_node(node)

        def write() -> None:
            for letter in "abc":
                postbox.letters.append(letter)
                executor.wake()

        thread = threading.Thread(target=write)
        thread.start()
        spin_until(executor, lambda: len(postbox.read) == 3)
        thread.join(PATIENCE)
    assert "".join(postbox.read) == "abc"


def test_done_callbacks_of_its_futures_run_in_the_executor(node: Node, executor: SingleThreadedExecutor) -> None:
    future, heard = Future[str](), list[Any]()
    future.add_done_callback(lambda done: heard.append(executor.spins_here))

    class Completing(Postbox):
        async def execute(self, taken_data: str) -> None:
            future.set_result(taken_data)
            assert heard == []

    postbox = Completing()
    postbox.add_future(future)
    postbox.letters.append("a")
    node.add_waitable(postbox)
    spin_for(executor, 0.1)
    postbox.remove_future(future)
    assert heard == [True]


def test_there_are_no_wait_sets(node: Node, executor: SingleThreadedExecutor) -> None:
    class Rcl(Postbox):
        def add_to_wait_set(self, wait_set: WaitSet) -> None:
            wait_set.add_timer(None)

    node.add_waitable(Rcl())
    with pytest.raises(NotImplementedError, match=r"no rcl wait sets, so there is no 'add_timer'.*executor\.wake"):
        executor.spin_once(timeout_sec=0)


def test_numbers_of_entities_are_added() -> None:
    both = NumberOfEntities(1, 2, 3, 4, 5, 6) + NumberOfEntities(10, 20, 30, 40, 50, 60)
    assert (both.num_subscriptions, both.num_guard_conditions, both.num_timers) == (11, 22, 33)
    assert (both.num_clients, both.num_services, both.num_events) == (44, 55, 66)


def test_a_waitable_that_does_nothing_is_no_burden(node: Node, executor: SingleThreadedExecutor) -> None:
    class Silent(Postbox):
        def __init__(self) -> None:
            super().__init__()
            self.callback_group = ReentrantCallbackGroup()

    silent, ticks = Silent(), list[int]()
    node.add_waitable(silent)
    node.create_timer(1.0, lambda: ticks.append(1))
    spin_for(executor, 10.5)
    assert len(ticks) == 10
    assert silent.asked < 50
