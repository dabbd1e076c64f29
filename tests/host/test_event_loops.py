"""Event loops of asyncio in a host: in virtual time, the same each time; their sockets and processes are real."""

from __future__ import annotations

import asyncio
import gc
import logging as python_logging
import socket
import sys
from typing import Any

import pytest

from robolink import Node
from robolink.host import Host, HostError, Program
from robolink.host.event_loop import FREE_TURNS
from robolink.interfaces.std_msgs.msg import Int32
from tests.support.hosts import Counter, Listener, Stage, traced

needs_unix = pytest.mark.skipif(sys.platform == "win32", reason="this loop of asyncio starts no processes there")


def run(stage: Stage, text: str, *args: str) -> Program:
    """Run a script to its end, in which assertions are."""
    program = stage.start("loop", f"import asyncio, sys, threading, time\n{text}", *args)
    assert stage.host.run_until(lambda: program.is_over, 1e5)
    assert (program.error, program.returncode) == (None, 0)
    return program


def real_time(host: Host) -> list[str]:
    return sorted({each.what for each in host.real_time_use})


WAITS = """
async def work(items, done):
    while True:
        seconds = await items.get()
        await asyncio.sleep(seconds)
        done.append(seconds)
        items.task_done()

async def main():
    loop, items, done = asyncio.get_running_loop(), asyncio.Queue(), []
    begin = loop.time()
    assert begin == time.monotonic()
    workers = [asyncio.create_task(work(items, done)) for _ in range(2)]
    for each in (1, 3, 2):
        items.put_nowait(each)
    await items.join()
    assert (done, loop.time() - begin) == ([1, 3, 2], 3.0)
    try:
        await asyncio.wait_for(asyncio.Event().wait(), 5)
    except asyncio.TimeoutError:
        assert loop.time() - begin == 8.0
    done = await asyncio.gather(asyncio.sleep(3, "slow"), asyncio.sleep(1, "fast"))
    assert (done, loop.time() - begin) == (["slow", "fast"], 11.0)
    if sys.version_info >= (3, 11):
        try:
            async with asyncio.timeout(1):
                await asyncio.sleep(2)
        except TimeoutError:
            assert loop.time() - begin == 12.0
    for each in workers:
        each.cancel()

asyncio.run(main())
"""


def test_waits_are_virtual_and_others_go_on_meanwhile(stage: Stage) -> None:
    counter = stage.host.start_node(Counter)
    run(stage, WAITS)
    assert counter.count in (109, 119, 120)
    assert real_time(stage.host) == []


def test_threads_of_a_program_do_work_for_its_loop_and_wake_it(stage: Stage) -> None:
    text = """
async def main():
    loop, woken = asyncio.get_running_loop(), asyncio.Event()
    loop.set_debug(sys.argv[1] == "debug")
    assert await loop.run_in_executor(None, lambda: time.sleep(2) or 7) == 7
    assert await asyncio.to_thread(lambda: time.monotonic()) == 3.0 == loop.time()
    def wake():
        time.sleep(1.5)
        loop.call_soon_threadsafe(woken.set)
    threading.Thread(target=wake).start()
    await woken.wait()
    assert loop.time() == 4.5
    coroutine = asyncio.sleep(1, "done")
    future = await asyncio.to_thread(lambda: asyncio.run_coroutine_threadsafe(coroutine, loop))
    assert await asyncio.wrap_future(future) == "done"
    assert loop.time() == 5.5
asyncio.run(main())
"""
    for mode in ("debug", "usual"):
        with Host() as host:
            run(Stage(stage.folder, host), text, mode)


def test_a_loop_that_never_waits_does_not_stop_time(stage: Stage) -> None:
    text = """
async def main():
    turns, end = 0, asyncio.get_running_loop().time() + 0.5
    while asyncio.get_running_loop().time() < end:
        turns += 1
        await asyncio.sleep(0)
    assert int(sys.argv[1]) < turns < int(sys.argv[1]) + 600
asyncio.run(main())
"""
    counter = stage.host.start_node(Counter)
    run(stage, text, str(FREE_TURNS))
    assert counter.count in (4, 5)


def test_a_loop_belongs_to_its_program_though_workers_of_the_host_are_shared(stage: Stage) -> None:
    """`get_event_loop` makes one in the main thread, as Python did until 3.13."""
    text = """
if sys.version_info < (3, 14):
    loop = asyncio.get_event_loop()
else:
    loop = asyncio.new_event_loop()
    asyncio.set_event_loop(loop)
assert loop is asyncio.get_event_loop() and not loop.is_closed()
loop.run_until_complete(asyncio.sleep(1))
assert loop.time() == time.monotonic()
time.sleep(1)
asyncio.run(asyncio.sleep(1))
try:
    asyncio.get_event_loop()
except RuntimeError as error:
    assert "no current event loop" in str(error)
loop.close()
"""
    programs = [stage.start(f"loop{number}", f"import asyncio, sys, time\n{text}") for number in range(3)]
    assert stage.host.run_until(lambda: all(each.is_over for each in programs), 100.0)
    assert [each.error for each in programs] == [None] * 3


class Talks(Node):
    """Has a loop of asyncio in a thread, whose tasks publish; most numbers come at one moment with others."""

    def __init__(self) -> None:
        super().__init__("talks")
        import threading

        self.numbers = self.create_publisher(Int32, "numbers", 10)
        threading.Thread(target=lambda: asyncio.run(self.main()), daemon=True).start()

    async def main(self) -> None:
        while True:
            tasks = {asyncio.create_task(self.talk(number)) for number in range(20)}
            done, pending = await asyncio.wait(tasks, timeout=0.35)
            for each in (*done, *pending):
                self.say(1000 if each.cancel() else each.result())
                self.get_logger().info(each.get_name() if isinstance(each, asyncio.Task) else "")

    async def talk(self, number: int) -> int:
        for _ in range(3):
            await asyncio.sleep(number % 7 / 50)
            self.say(number)
        return number

    def say(self, number: int) -> None:
        self.numbers.publish(Int32(data=number))


KNOWN = "6f498cedf4cc7ff7ca0521ef186888d2859240715616d704ce855be5c9cc4f41"


def test_what_tasks_do_is_the_same_each_time_and_on_every_python() -> None:
    def start(host: Host) -> Any:
        return host.start_node(Talks), host.start_node(Listener), host.start_node(Counter)

    digest, counts = traced(20.0, start)
    assert counts["/numbers"] > 1000
    assert digest == traced(20.0, start)[0] == KNOWN


ENDS = """
async def other():
    try:
        await asyncio.sleep(1e6)
    finally:
        print("other", flush=True)
async def main():
    task = asyncio.create_task(other())
    try:
        await asyncio.sleep(1e6)
    except asyncio.CancelledError:
        print("main", flush=True)
        raise
try:
    asyncio.run(main())
except KeyboardInterrupt:
    print("interrupted", flush=True)
"""


def test_an_interrupt_cancels_the_main_task_first(stage: Stage, capsys: pytest.CaptureFixture[str]) -> None:
    program = stage.start("loop", f"import asyncio\n{ENDS}")
    stage.host.run(5.0)
    stage.host.stop("loop")
    assert capsys.readouterr().out.split() == ["main", "other", "interrupted"]
    assert (program.error, program.returncode) == (None, 0)


def test_a_loop_may_handle_the_interrupt_itself(stage: Stage, capsys: pytest.CaptureFixture[str]) -> None:
    text = """
import asyncio, signal
async def main():
    stop = asyncio.Event()
    asyncio.get_running_loop().add_signal_handler(signal.SIGINT, stop.set)
    await stop.wait()
    assert asyncio.get_running_loop().remove_signal_handler(signal.SIGINT)
    print("stopped")
asyncio.run(main())
"""
    program = stage.start("loop", text)
    stage.host.run(5.0)
    stage.host.stop("loop")
    assert capsys.readouterr().out == "stopped\n"
    assert (program.error, program.returncode) == (None, 0)


def test_a_killed_program_leaves_its_tasks_without_a_word(
    stage: Stage,
    caplog: pytest.LogCaptureFixture,
    recwarn: pytest.WarningsRecorder,
    capsys: pytest.CaptureFixture[str],
) -> None:
    endless = (
        "import asyncio\nloop = asyncio.new_event_loop()\nloop.create_task(asyncio.sleep(1e6))\nloop.run_forever()"
    )
    with caplog.at_level(python_logging.DEBUG, "asyncio"):
        stage.start("run", f"import asyncio\n{ENDS}")
        stage.start("forever", endless)
        stage.host.run(5.0)
        stage.host.crash("run")
        stage.host.crash("forever")
        stage.host.run(5.0)
        gc.collect()
    assert "main" not in capsys.readouterr().out
    assert [each.message for each in caplog.records if "Using selector" not in each.message] == []
    assert not recwarn.list


def test_programs_that_all_wait_for_ever_are_named_by_their_lines(stage: Stage) -> None:
    stage.start("loop", "import asyncio\nasync def main():\n    await asyncio.Event().wait()\nasyncio.run(main())")
    with pytest.raises(HostError, match=r"wait for ever.*loop at .*loop\.py:4"):
        stage.host.time.wait_until(lambda: False, None)


SERVES = """
async def handle(reader, writer):
    line = await reader.readline()
    await asyncio.sleep(0.02)
    writer.write(line.upper())
    await writer.drain()
    writer.close()

async def main():
    loop = asyncio.get_running_loop()
    server = await asyncio.start_server(handle, "127.0.0.1", int(sys.argv[1]))
    await asyncio.sleep(1000)
    assert loop.time() == 1001.0
    reader, writer = await asyncio.open_connection(*server.sockets[0].getsockname())
    writer.write(b"hello\\n")
    assert await reader.readline() == b"HELLO\\n"
    writer.close()
    await asyncio.sleep(1000)
    assert 2001.0 < loop.time() < 2010.0
    if len(sys.argv) > 2:
        await asyncio.sleep(1e6)
    server.close()
"""


def test_sockets_are_real_and_a_server_that_listens_holds_up_nobody(stage: Stage) -> None:
    run(stage, f"{SERVES}\nasyncio.run(main())", "0")
    assert real_time(stage.host) == ["asyncio socket"]


@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")  # sockets that nobody has closed
def test_a_server_that_was_killed_starts_again_at_its_port(stage: Stage) -> None:
    with socket.create_server(("127.0.0.1", 0)) as free:
        port = free.getsockname()[1]
    program = stage.start("loop", f"import asyncio, sys\n{SERVES}\nasyncio.run(main())", str(port), "stay")
    stage.host.run(2500.0)
    stage.host.crash("loop")
    stage.host.restart("loop")
    stage.host.run(100.0)
    assert (program.state, program.error) == ("running", None)
    stage.host.close()
    gc.collect()


@pytest.mark.processes
@needs_unix
def test_time_goes_no_faster_than_a_process_that_a_loop_waits_for(stage: Stage) -> None:
    text = """
async def main():
    loop = asyncio.get_running_loop()
    sleep = [sys.executable, "-c", "import time; print(time.sleep(0.05))"]
    process = await asyncio.create_subprocess_exec(*sleep, stdout=asyncio.subprocess.PIPE)
    assert await process.communicate() == (b"None\\n", None)
    assert 1.05 < loop.time() < 30.0
    begin = loop.time()
    process = await asyncio.create_subprocess_exec(*sleep[:2], "import time; time.sleep(60)")
    try:
        await asyncio.wait_for(process.wait(), 0.1)
    except asyncio.TimeoutError:
        process.kill()
    assert await process.wait() == -9
    assert 0.1 < loop.time() - begin < 30.0
    await asyncio.sleep(1000)
asyncio.run(main())
"""
    run(stage, text)


class Asks(Node):
    """Waits in a loop of its own in a callback, and holds up its others meanwhile."""

    def __init__(self) -> None:
        super().__init__("asks")
        self.came = list[float]()
        self.create_timer(0.5, self.on_timer)

    def on_timer(self) -> None:
        asyncio.run(asyncio.sleep(0.75))
        self.came.append(self.get_clock().now().nanoseconds / 1e9)


def test_a_callback_may_run_a_loop(stage: Stage) -> None:
    asks, counter = stage.host.start_node(Asks), stage.host.start_node(Counter)
    stage.host.run(3.0)
    assert asks.came == [2.25, 3.0, 3.75]
    assert counter.count in (29, 30)


def test_a_loop_outside_of_programs_stays_real() -> None:
    with Host() as host:
        host.run(1e6)
        loop = asyncio.new_event_loop()
        loop.close()
        assert type(loop).__module__.startswith("asyncio")
        assert asyncio.run(asyncio.sleep(0, "done")) == "done"
