"""Networks, contexts and executors for tests: in memory, and over Zenoh on a domain that nobody else uses."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from robolink import Context, VirtualTime, logging, try_shutdown
from robolink.executors import SingleThreadedExecutor
from robolink.impl.log_output import Record, output
from robolink.transport.memory import Bus, MemoryTransport
from robolink.transport.zenoh import ZenohTransport
from tests.domains import free_domain
from tests.transports import Network


@pytest.fixture
def domain() -> Iterator[int]:
    """A domain that no other test uses now."""
    with free_domain() as number:
        yield number


@pytest.fixture(params=["memory", "zenoh"])
def net(request: pytest.FixtureRequest) -> Iterator[Network]:
    if request.param == "memory":
        bus = Bus()
        network = Network(lambda: MemoryTransport(bus=bus))
    else:
        number = request.getfixturevalue("domain")
        network = Network(lambda: ZenohTransport(number, environ={}))
    yield network
    network.close()


@pytest.fixture
def zenoh_net(domain: int) -> Iterator[Network]:
    network = Network(lambda: ZenohTransport(domain, environ={}))
    yield network
    network.close()


@pytest.fixture(autouse=True)
def _as_before() -> Iterator[None]:
    """End the default context, the signal handlers and what was set about logging."""
    console, now = output.console, output.now
    yield
    try_shutdown(uninstall_handlers=True)
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
def log_lines() -> Iterator[list[Record]]:
    """Collect what is logged; the console is silent."""
    found: list[Record] = []
    logging.set_console_handler(None)
    logging.add_handler(found.append)
    yield found
    logging.remove_handler(found.append)
