"""Python's own pools of threads in a host: they work in virtual time, and the same each time."""

from __future__ import annotations

import logging as python_logging
import threading
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import pytest

from robolink import Node
from robolink.host import Host
from tests.support.hosts import Counter, Stage, traced

AT_MODULE_LEVEL = ThreadPoolExecutor(2)


def run(stage: Stage, text: str) -> None:
    program = stage.start("pool", text)
    assert stage.host.run_until(lambda: program.is_over, 100.0)
    assert (program.error, program.returncode) == (None, 0)
    assert not any("by itself" in use.what for use in stage.host.real_time_use)


def test_a_pool_works_in_virtual_time(stage: Stage) -> None:
    counter = stage.host.start_node(Counter)
    text = """
import time
from concurrent.futures import FIRST_COMPLETED, ThreadPoolExecutor, TimeoutError, as_completed, wait

def work(seconds):
    time.sleep(seconds)
    return seconds, time.monotonic() - begin

begin = time.monotonic()
with ThreadPoolExecutor(2) as pool:
    assert list(pool.map(abs, [-1, 2, -3])) == [1, 2, 3]
    assert [each[0] for each in pool.map(work, [1.0, 1.0, 1.0])] == [1.0, 1.0, 1.0]
    assert round(time.monotonic() - begin, 6) == 2.0
    slow, fast = pool.submit(work, 1.5), pool.submit(work, 1.0)
    assert wait([slow, fast], return_when=FIRST_COMPLETED).done == {fast}
    assert [each.result()[0] for each in as_completed([slow, fast])] == [1.0, 1.5]
    late = pool.submit(work, 5.0)
    for ask in (late.result, lambda **given: list(as_completed([late], **given)), late.exception):
        try:
            ask(timeout=0.25)
        except TimeoutError:
            continue
        assert False
    assert round(time.monotonic() - begin, 2) == 4.25  # as_completed asks some times more at the end
assert round(time.monotonic() - begin, 6) == 8.5
assert late.result() == (5.0, late.result()[1])
"""
    run(stage, text)
    assert counter.count in (84, 85)


def left() -> list[threading.Thread]:
    """Give the threads of programs' pools that do not end."""
    theirs = [each for each in threading.enumerate() if each.name.startswith("theirs")]
    for each in theirs:
        each.join(30.0)
    return [each for each in theirs if each.is_alive()]


ENDS = (
    "import logging, time\nfrom concurrent.futures import ThreadPoolExecutor\npool = ThreadPoolExecutor(3, 'theirs')\n"
)


@pytest.mark.parametrize(
    ("work", "is_told"),
    [
        ("pool.submit(abs, -1).result()", False),
        ("pool.submit(abs, -1)", False),
        ("pool.submit(time.sleep, 2)", False),
        ("pool.submit(time.sleep, 1e6)", True),
    ],
)
def test_a_pool_that_nobody_shuts_down_ends_with_its_program(
    stage: Stage, log: list[str], caplog: pytest.LogCaptureFixture, work: str, is_told: bool
) -> None:
    run(stage, ENDS + work)
    stage.host.run(5.0)
    stage.host.close()
    assert any("goes on after its end" in line for line in log) == is_told
    assert not caplog.records
    assert not left()


@pytest.mark.parametrize("end", [Host.close, lambda host: host.crash("pool"), lambda host: host.stop("pool")])
def test_idle_and_busy_threads_end_with_a_program_that_is_ended(
    stage: Stage, caplog: pytest.LogCaptureFixture, end: Callable[[Host], object]
) -> None:
    stage.start("pool", ENDS + "list(pool.map(time.sleep, [1, 2]))\npool.submit(time.sleep, 50)\ntime.sleep(100)")
    stage.host.run(5.0)
    end(stage.host)
    stage.host.close()
    assert not left()
    assert not caplog.records


def test_what_goes_wrong_in_a_pool_itself_is_told(stage: Stage, caplog: pytest.LogCaptureFixture) -> None:
    with caplog.at_level(python_logging.CRITICAL, "concurrent.futures"):
        run(
            stage,
            """
from concurrent.futures import ThreadPoolExecutor
from concurrent.futures.thread import BrokenThreadPool
def begin():
    raise ValueError("cannot begin")
try:
    with ThreadPoolExecutor(1, initializer=begin) as pool:
        pool.submit(abs, -1).result()
except BrokenThreadPool:
    pass
""",
        )
    assert [record.message for record in caplog.records] == ["Exception in initializer:"]


def test_pools_of_several_programs_and_of_threads_keep_out_of_each_others_way(stage: Stage) -> None:
    text = """
import threading, time
from concurrent.futures import ThreadPoolExecutor
def use():
    for n in range(20):
        with ThreadPoolExecutor(3) as pool:
            assert sum(pool.map(lambda n: time.sleep(n / 100) or n, range(5))) == 10
threads = [threading.Thread(target=use) for _ in range(3)]
for each in threads:
    each.start()
for each in threads:
    each.join()
"""
    programs = [stage.start(f"pool{number}", text) for number in range(3)]
    assert stage.host.run_until(lambda: all(each.is_over for each in programs), 100.0)
    assert [each.error for each in programs] == [None] * 3
    assert not any("by itself" in use.what for use in stage.host.real_time_use)


class Works(Node):
    """Has a pool work for its callbacks, and publishes what comes of it."""

    def __init__(self, pool: ThreadPoolExecutor | None = None) -> None:
        super().__init__("works")
        from robolink.interfaces.std_msgs.msg import Int32

        self.make = Int32
        self.results = self.create_publisher(Int32, "results", 10)
        self.pool = pool or ThreadPoolExecutor(3)
        self.count = 0
        self.create_timer(0.1, self.tick)

    def tick(self) -> None:
        self.count += 1
        for part in range(5):
            self.pool.submit(self.work, self.count * 10 + part)

    def work(self, number: int) -> None:
        import time

        time.sleep((number * 7 % 13) / 100)
        self.results.publish(self.make(data=number))


class WorksElsewhere(Works):
    """The same, in a pool that was there before."""

    def __init__(self) -> None:
        super().__init__(AT_MODULE_LEVEL)


def test_work_for_callbacks_repeats_to_the_byte() -> None:
    def start(host: Host) -> Any:
        return host.start_node(Works), host.start_node(Counter)

    first, counts = traced(10.0, start)
    assert counts["/results"] == 491
    assert traced(10.0, start)[0] == first


def test_a_pool_made_before_there_was_a_host_works_in_virtual_time(stage: Stage) -> None:
    stage.host.start_node(WorksElsewhere)
    stage.host.run(1.0)
    assert not any("by itself" in use.what for use in stage.host.real_time_use)
    assert len(AT_MODULE_LEVEL._threads) == 2


def test_the_loop_of_asyncio_may_have_work_done_in_a_thread(stage: Stage) -> None:
    text = "import asyncio\nasync def main():\n    assert await asyncio.to_thread(abs, -3) == 3\nasyncio.run(main())\n"
    program = stage.start("loop", text)
    assert stage.host.run_until(lambda: program.is_over, 100.0)
    assert (program.error, program.returncode) == (None, 0)
