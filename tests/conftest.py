"""Networks, contexts and executors for tests: in memory, and over Zenoh on a domain that nobody else uses.

What a `long_run` names is started as soon as it is known that its test will run, and that test comes last of all, or
of its file.
"""

from __future__ import annotations

import contextlib
import gc
import os
import platform
import re
import signal
import sys
import tempfile
from collections.abc import Generator, Iterator
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, settings

from robolink import Context, VirtualTime, logging, try_shutdown
from robolink.executors import MultiThreadedExecutor, SingleThreadedExecutor
from robolink.host.patches.environment import process_as_before
from robolink.impl.log_output import Record, output
from robolink.transport import joining, shared_memory, zenoh, zenoh_handles
from robolink.transport.memory import Bus, MemoryTransport
from robolink.transport.zenoh import ZenohTransport
from tests.support import process_starts
from tests.support.domains import free_domain
from tests.support.launchers import RUNTIME_VARIABLE, new_runtime_folder
from tests.support.long_runs import LongRun
from tests.support.transports import Network
from tools.without_annex import is_here

# pytest keeps what it has made of the tests, though the environment may say otherwise: else every worker takes
# 18 s of a processor to make it again (25 instead of 7).
sys.dont_write_bytecode = False

# However slow a machine is, that is no fault of what is tested.
settings.register_profile(
    "patient", settings(), deadline=None, max_examples=50, suppress_health_check=[HealthCheck.too_slow]
)
settings.register_profile("quick", settings.get_profile("patient"), max_examples=10)  # for `make fast`
settings.load_profile("patient")

WITHOUT_PROCESSES = "not processes"
"""What the expression of marks begins with in `make fast`."""
ALL_START_PROCESSES = re.compile(r"^pytestmark = .*\bpytest\.mark\.processes\b", re.MULTILINE)

LONG_RUNS = pytest.StashKey[dict[tuple[Any, ...], LongRun]]()
THEIR_FILES = pytest.StashKey[set[Path]]()


def pytest_configure(config: pytest.Config) -> None:
    """Keep what is launched out of the user's home and apart from their own launchers; have Ctrl-C as in a terminal.

    A shell starts what it runs in the background with SIGINT ignored, and all that it starts in turn. What a user of
    ROS 2 has in it, such as ROS_DOMAIN_ID or ROS_DISTRO, does not reach the tests.
    """
    for name in [each for each in os.environ if each.startswith(("ROS_", "RCUTILS_", "ROBOLINK_"))]:
        del os.environ[name]
    os.environ.pop("PYTHONDONTWRITEBYTECODE", None)  # hundreds of processes would each compile what they import
    if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
        signal.signal(signal.SIGINT, signal.default_int_handler)
    folder = tempfile.TemporaryDirectory(prefix="robolink-logs-", ignore_cleanup_errors=True)
    config.add_cleanup(folder.cleanup)
    os.environ["ROBOLINK_LOG_DIR"] = folder.name
    runtime = new_runtime_folder()
    config.add_cleanup(runtime.cleanup)
    os.environ[RUNTIME_VARIABLE] = runtime.name


def pytest_ignore_collect(collection_path: Path, config: pytest.Config) -> bool | None:
    """Leave out files whose tests all start processes, where none of them will run: they need not be imported."""
    if not config.option.markexpr.startswith(WITHOUT_PROCESSES) or collection_path.suffix != ".py":
        return None
    return True if ALL_START_PROCESSES.search(collection_path.read_text(encoding="utf-8")) else None


def runs_long(item: pytest.Item) -> bool:
    return item.get_closest_marker("long_run") is not None


def is_one_of_several(config: pytest.Config) -> bool:
    """Whether other processes run other files of tests meanwhile, as `make test` has it."""
    return hasattr(config, "workerinput")


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Put the long runs last; but of several processes one begins with their file, and waits while the others work."""
    items.sort(key=runs_long)
    files = config.stash[THEIR_FILES] = {item.path for item in items if runs_long(item)}
    if is_one_of_several(config):
        items.sort(key=lambda item: item.path not in files)


def pytest_collection_finish(session: pytest.Session) -> None:
    """Start the long runs; and have the garbage collector pass over all that has been collected, from now on."""
    gc.collect()
    gc.freeze()
    if not session.config.option.collectonly and not is_one_of_several(session.config):
        start_long_runs(session)


def pytest_runtest_setup(item: pytest.Item) -> None:
    """Skip the tests of an annex that is not there; start the long runs with their file, where others begin first."""
    for mark in item.iter_markers("annex"):
        for name in mark.args:
            if not is_here(name):
                pytest.skip(f"this copy has no {name}")
    if item.path in item.config.stash[THEIR_FILES] and LONG_RUNS not in item.config.stash:
        start_long_runs(item.session)


def start_long_runs(session: pytest.Session) -> None:
    marks = [item.get_closest_marker("long_run") for item in session.items]
    session.config.stash[LONG_RUNS] = {mark.args: LongRun(*mark.args) for mark in marks if mark}


def pytest_sessionfinish(session: pytest.Session) -> None:
    """End those that still run, since a test failed or was interrupted."""
    for run in session.config.stash.get(LONG_RUNS, {}).values():
        run.close()


def pytest_sessionstart(session: pytest.Session) -> None:
    """Watch for processes from now on; Python starts one itself when it is first asked for the processor's name."""
    platform.processor()
    process_starts.watch()
    option = session.config.option
    if is_one_of_several(session.config) and option.durations is None and option.xmlpath is None:
        report_less(session.config)


def report_less(config: pytest.Config) -> None:
    """Send the first process one report of a test that passes instead of three, and not its start: half of its work.

    Six messages for each of thirteen thousand tests take as long as five hundred tests.
    """
    worker = next(each for each in config.pluginmanager.get_plugins() if hasattr(each, "sendevent"))
    send = worker.sendevent

    def sendevent(name: str, **content: Any) -> None:
        report = content.get("data") or {}
        passed = name == "testreport" and report.get("outcome") == "passed" and report.get("when") != "call"
        if name != "logstart" and not passed:
            send(name, **content)

    worker.sendevent = sendevent


@pytest.hookimpl(wrapper=True)
def pytest_runtest_protocol(item: pytest.Item) -> Generator[None, object, object]:
    """Fail a test that starts a process and is not marked: `make fast` leaves out those that are."""
    process_starts.started()
    return (yield)


@pytest.hookimpl(wrapper=True)
def pytest_runtest_teardown(item: pytest.Item, nextitem: pytest.Item | None) -> Generator[None, object, object]:
    """Fail a test that starts a process without the mark, and the last one of a file that leaves zombies."""
    result = yield
    events = process_starts.started()
    if events and item.get_closest_marker("processes") is None:
        pytest.fail(f"starts a process ({events[0]}): mark it with @pytest.mark.processes", pytrace=False)
    if (nextitem is None or nextitem.path != item.path) and (zombies := process_starts.zombies()):
        pytest.fail(f"{item.path} leaves zombies: {zombies}", pytrace=False)
    return result


@pytest.fixture
def long_run(request: pytest.FixtureRequest) -> LongRun:
    """The run that the test's mark names."""
    mark = request.node.get_closest_marker("long_run")
    return request.config.stash[LONG_RUNS][mark.args]


@pytest.fixture
def domain() -> Iterator[int]:
    """A domain that no other test uses now."""
    with free_domain() as number:
        yield number


@pytest.fixture(params=["memory", "zenoh", pytest.param("dds", marks=pytest.mark.annex("dds"))])
def net(request: pytest.FixtureRequest) -> Iterator[Network]:
    with contextlib.ExitStack() as stack:
        if request.param == "memory":
            bus = Bus()
            network = Network(lambda: MemoryTransport(bus=bus))
        elif request.param == "zenoh":
            number = request.getfixturevalue("domain")
            network = Network(lambda: ZenohTransport(number, environ={}))
        else:
            if (mark := request.node.get_closest_marker("unlike_dds")) is not None:
                pytest.skip(mark.args[0])
            network = stack.enter_context(dds_in_memory())
        yield network
        network.close()


@contextlib.contextmanager
def dds_in_memory() -> Iterator[Network]:
    from robolink.dds.transport import DdsTransport
    from tests.support.fake_rtps import FakeNetwork

    with contextlib.closing(FakeNetwork()) as fake:
        opens: Any = fake.open
        yield Network(lambda: DdsTransport(opens))


@pytest.fixture
def zenoh_net(domain: int) -> Iterator[Network]:
    network = Network(lambda: ZenohTransport(domain, environ={}))
    yield network
    network.close()


@pytest.fixture
def patient_looks(monkeypatch: pytest.MonkeyPatch) -> None:
    """Looks at the graph wait for those, too, whom a machine that does ten things at once holds up for a while."""
    for name, seconds in {"QUIET": 0.3, "PATIENCE": 5.0, "LONGEST": 30.0}.items():
        monkeypatch.setattr(zenoh_handles, name, seconds)
    monkeypatch.setattr(zenoh, "REUNION", 0.5)
    monkeypatch.setattr(joining, "LINK_WITHIN", 30.0)


@pytest.fixture
def known_as_robolink(monkeypatch: pytest.MonkeyPatch) -> None:
    """Errors speak of robolink, although another test may have imported it as rclpy."""
    monkeypatch.delitem(sys.modules, "rclpy", raising=False)


@pytest.fixture(autouse=True)
def _as_before() -> Iterator[None]:
    """End the default context, the signal handlers, what was set about logging, and what was changed of the process."""
    console, now = output.console, output.now
    handlers = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)}
    with process_as_before():
        yield
    try_shutdown(uninstall_handlers=True)
    for number, handler in handlers.items():  # a coroutine whose loop was closed never leaves its block of handlers
        if signal.getsignal(number) != handler:
            signal.signal(number, handler)
    output.console, output.now = console, now
    logging.clear_config()


@pytest.fixture
def bus() -> Bus:
    return Bus()


@pytest.fixture
def context(bus: Bus) -> Iterator[Context]:
    """A context in memory, in the time of this computer."""
    made = Context(transport=MemoryTransport(bus=bus))
    made.init([])
    with made:
        yield made


@pytest.fixture
def virtual(bus: Bus) -> Iterator[Context]:
    """A context in memory, in virtual time."""
    made = Context(transport=MemoryTransport(bus=bus), time=VirtualTime())
    made.init([])
    with made:
        yield made


@pytest.fixture
def executor(virtual: Context) -> Iterator[SingleThreadedExecutor]:
    """An executor in virtual time."""
    with SingleThreadedExecutor(context=virtual) as made:
        yield made


@pytest.fixture
def two(context: Context) -> Iterator[MultiThreadedExecutor]:
    """An executor with two threads, in real time."""
    with MultiThreadedExecutor(num_threads=2, context=context) as made:
        yield made


@pytest.fixture
def log_lines() -> Iterator[list[Record]]:
    """Collect what is logged; the console is silent.

    What this process holds of others' shared memory is left out: that is all earlier tests' doing.
    """
    found: list[Record] = []

    def collect(record: Record) -> None:
        if record.file != shared_memory.__file__:
            found.append(record)

    logging.set_console_handler(None)
    logging.add_handler(collect)
    yield found
    logging.remove_handler(collect)
