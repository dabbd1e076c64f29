"""What only a network between processes has: crashes, exits, ports, domains, and foreign peers."""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import ExitStack, closing, contextmanager, suppress
from pathlib import Path

import pytest
import zenoh

from robolink.exceptions import TransportError
from robolink.networks.request import FIRST_PORT
from robolink.networks.settings import most_pending
from robolink.transport import network
from robolink.transport.zenoh import ZenohTransport
from robolink.transport.zenoh_declare import is_matching, quietly
from robolink.transport.zenoh_readers import READERS
from tests.support.domains import free_domain
from tests.support.transports import (
    ADD,
    CHATTER,
    GRAPH,
    KEEP_ALL,
    PATIENCE,
    PLAIN,
    Caller,
    Ear,
    Network,
    Watcher,
    reach,
    until,
)

pytestmark = pytest.mark.processes

BEGIN = f"""
import os, queue, sys, threading
from robolink.qos import QoSProfile
from robolink.transport.zenoh import ZenohTransport
session = ZenohTransport(int(sys.argv[1]), environ=dict())
plain, keep_all, latched = QoSProfile(depth=10), QoSProfile(history=2), QoSProfile(depth=1, durability=1)
arrived = queue.SimpleQueue()
key = "{CHATTER}"
"""
SILENT = 200
"""Connections to the rendezvous port that say nothing."""
WAIT = "\nprint('ready', flush=True)\nsys.stdin.read()\n"


@contextmanager
def process(domain: int, code: str) -> Iterator[subprocess.Popen[str]]:
    command = [sys.executable, "-c", BEGIN + code, str(domain)]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as child:
        try:
            assert child.stdout
            assert child.stdout.readline() == "ready\n"
            yield child
        finally:
            child.kill()


def run(domain: int, code: str, *arguments: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-c", BEGIN + code, str(domain), *arguments]
    return subprocess.run(command, capture_output=True, text=True, timeout=PATIENCE, check=False)


# ---------------------------------------------------------------- crashes and exits


def test_the_tokens_of_a_killed_process_disappear(zenoh_net: Network, domain: int) -> None:
    watcher = Watcher(zenoh_net.session())
    with process(domain, "session.announce('@ros2_lv/0/a/x')" + WAIT) as child:
        assert watcher.next() == ("@ros2_lv/0/a/x", True)
        child.kill()
        assert watcher.next() == ("@ros2_lv/0/a/x", False)


EVERYTHING_OPEN = """
session.subscribe(key, plain, arrived.put)
session.subscribe(key, latched, lambda sample: arrived.put(sample))
session.serve("a/service", arrived.put)
session.watch("@ros2_lv/0/**", lambda token, alive: arrived.put(token))
session.announce("@ros2_lv/0/a/x")
outlet = session.advertise(key, keep_all)
call = session.call("a/service", b"", b"", arrived.put)

def publish():
    while True:
        outlet.put(bytes(1000), b"")

threading.Thread(target=publish, daemon=True).start()
for _ in range(100):
    arrived.get(timeout=30)
"""


@pytest.mark.parametrize(("ending", "code"), [("", 0), ("sys.exit(3)", 3), ("raise ValueError('x')", 1)])
def test_the_interpreter_exits_with_a_session_left_open(domain: int, ending: str, code: int) -> None:
    done = run(domain, EVERYTHING_OPEN + ending)
    assert done.returncode == code
    assert ("ValueError" in done.stderr) is (code == 1)
    assert "FATAL" not in done.stderr


def test_the_interpreter_waits_for_a_session_that_still_closes(zenoh_net: Network, domain: int) -> None:
    for _ in range(5):
        zenoh_net.session()
    hasty = "from robolink.transport import zenoh\nzenoh.CLOSE_WITHIN = 0\nsession.close()\nsys.exit(4)"
    done = run(domain, hasty)
    assert (done.returncode, done.stderr) == (4, "")


def test_the_process_at_the_rendezvous_port_may_die(zenoh_net: Network, domain: int) -> None:
    with process(domain, WAIT) as holder:
        talker, listener = zenoh_net.session(), zenoh_net.session()
        outlet, ear = talker.advertise(CHATTER, KEEP_ALL), Ear(listener, qos=KEEP_ALL)
        reach(outlet, ear)
        for number in range(100):
            if number == 50:
                holder.kill()
            outlet.put(b"%d" % number, b"")
        holder.wait(PATIENCE)
        outlet.put(b"end", b"")
        assert ear.until(b"end") == [b"%d" % number for number in range(100)]
    newcomer = Ear(zenoh_net.session(), qos=KEEP_ALL)
    reach(outlet, newcomer, ear)
    outlet.put(b"welcome", b"")
    assert newcomer.next() == ear.next() == b"welcome"


@pytest.mark.usefixtures("patient_looks")
def test_who_comes_for_a_moment_after_that_sees_those_who_are_left(zenoh_net: Network, domain: int) -> None:
    with process(domain, WAIT) as holder:
        first, second = zenoh_net.session(), zenoh_net.session()
        first.announce("@ros2_lv/0/a/x")
        second.announce("@ros2_lv/0/b/y")
        until(lambda: len(first.tokens(GRAPH)) == len(second.tokens(GRAPH)) == 2)
        holder.kill()
        holder.wait(PATIENCE)
    for _ in range(5):  # commands, each of which takes the port and leaves it again
        command = ZenohTransport(domain, environ={})
        assert command.tokens(GRAPH) == ["@ros2_lv/0/a/x", "@ros2_lv/0/b/y"]
        command.close()


FROZEN_PEER = """
import signal, time
os.kill(int(sys.argv[2]), signal.SIGSTOP)
outlet, progress = session.advertise(key, keep_all), [time.monotonic()]

def publish():
    while True:
        outlet.put(bytes(20_000), b"")
        progress.append(time.monotonic())

threading.Thread(target=publish, daemon=True).start()
while len(progress) <= 10 or time.monotonic() - progress[-1] < 0.05:  # it waits for 0.13 s, then drops
    time.sleep(0.001)
begin = time.monotonic()
session.close()
print(time.monotonic() - begin < 4)  # Zenoh itself waits for 5 s
"""


@pytest.mark.skipif(not hasattr(signal, "SIGSTOP"), reason="Windows cannot freeze a process")
def test_a_session_closes_while_its_publisher_waits_for_a_frozen_process(domain: int) -> None:
    with process(domain, "session.subscribe(key, keep_all, arrived.put)" + WAIT) as peer:
        done = run(domain, FROZEN_PEER, str(peer.pid))
    assert (done.stdout, done.returncode) == ("True\n", 0)


SLOW_TO_CLOSE = """
import time
from robolink.transport import lifetime

lifetime.finish(lambda: (time.sleep(1.0), print("closed")), 0.0)  # a loaded machine: seen to take 0.7 s
"""


def test_the_exit_waits_for_a_session_that_is_slow_to_close(domain: int) -> None:
    done = run(domain, SLOW_TO_CLOSE)
    assert (done.stdout, done.stderr, done.returncode) == ("closed\n", "", 0)


FORK = """
outlet = session.advertise(key, latched)
subscription = session.subscribe(key, plain, arrived.put)
session.watch("@ros2_lv/0/**", print)
outlet.put(b"x", b"")
child = os.fork()
if child:
    _, status = os.waitpid(child, 0)
    outlet.put(b"y", b"")
    print("parent", os.waitstatus_to_exitcode(status), arrived.qsize())
    sys.exit()
for use in (lambda: outlet.put(b"x", b""), lambda: session.announce("t"), lambda: ZenohTransport(1)):
    try:
        use()
    except ConnectionError as error:
        print("spawn" in str(error), flush=True)
outlet.close(), subscription.close(), session.close()
sys.exit(5)
"""


@pytest.mark.skipif(not hasattr(os, "fork"), reason="Windows cannot fork")
def test_a_forked_child_is_told_and_exits(domain: int) -> None:
    done = run(domain, "import warnings\nwarnings.simplefilter('ignore')\n" + FORK)
    assert done.stdout.splitlines() == ["True", "True", "True", "parent 5 2"]


# ---------------------------------------------------------------- ports and domains


def test_nothing_listens_beyond_this_machine(zenoh_net: Network, domain: int) -> None:
    Ear(zenoh_net.session())
    zenoh_net.session()
    assert f"127.0.0.1:{FIRST_PORT + domain}" in listening()
    assert {address.rpartition(":")[0] for address in listening()} == {"127.0.0.1"}


def listening() -> set[str]:
    """Addresses on which this process listens: all of them on Linux, elsewhere what netstat knows."""
    tables = {name: Path(f"/proc/self/net/{name}") for name in ("tcp", "tcp6", "udp", "udp6")}
    if not tables["tcp"].exists():
        shown = subprocess.run(["netstat", "-an"], capture_output=True, text=True, check=True).stdout
        lines = [line.split() for line in shown.splitlines() if "LISTEN" in line]
        return {":".join(words[1 if os.name == "nt" else 3].rsplit(".", 1)) for words in lines}
    mine = open_files()
    found = set()
    for name, table in tables.items():
        for words in map(str.split, table.read_text().splitlines()[1:]):
            if int(words[9]) in mine and (words[3] == "0A" or name.startswith("udp")):
                found.add(address(words[1]))
    return found


def open_files() -> set[int]:
    """The numbers of the inodes that this process has open."""
    found = set()
    for link in Path("/proc/self/fd").iterdir():
        with suppress(OSError):  # one that has been closed meanwhile
            found.add(link.stat().st_ino)
    return found


def address(text: str) -> str:
    """Read `0100007F:1F90` as 127.0.0.1:8080; an IPv6 address stays in hex."""
    host, port = text.split(":")
    if len(host) == 8:
        host = socket.inet_ntoa(bytes.fromhex(host)[::-1])
    return f"{host}:{int(port, 16)}"


def test_two_domains_do_not_see_each_other(zenoh_net: Network) -> None:
    """Not even where they use the same key, which they do not."""
    with free_domain() as other, ExitStack() as stack:
        strangers = [stack.enter_context(closing(ZenohTransport(other, environ={}))) for _ in range(2)]
        ear, stranger = Ear(zenoh_net.session()), Ear(strangers[0])
        watcher = Watcher(strangers[0])
        session = zenoh_net.session()
        outlet, their_outlet = session.advertise(CHATTER, PLAIN), strangers[1].advertise(CHATTER, PLAIN)
        reach(their_outlet, stranger)
        reach(outlet, ear)
        session.announce("@ros2_lv/0/ours")
        strangers[1].announce("@ros2_lv/0/theirs")
        outlet.put(b"ours", b"")
        their_outlet.put(b"theirs", b"")
        assert (ear.next(), stranger.next()) == (b"ours", b"theirs")
        assert ear.arrived.empty()
        assert stranger.arrived.empty()
        assert watcher.next() == ("@ros2_lv/0/theirs", True)
        assert session.tokens(GRAPH) == ["@ros2_lv/0/ours"]


SQUATTED = """
from robolink.transport import zenoh
zenoh.LINK_WITHIN = 0.1
try:
    ZenohTransport(int(sys.argv[2]), environ={})
except ConnectionError as error:
    print(error)
"""


def test_a_port_held_by_something_else(domain: int) -> None:
    with socket.socket() as squatter:
        port = FIRST_PORT + domain
        if os.name != "nt":  # else connections that have ended keep the port for a minute
            squatter.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        squatter.bind(("127.0.0.1", port))
        squatter.listen()
        done = run(domain % 232 + 1, SQUATTED, str(domain))
    assert done.stdout == (
        f"port {port} is taken by a program that does not answer as a robolink session does: "
        "go on with it if it was suspended (Ctrl-Z; `fg`), stop it, or choose another ROS_DOMAIN_ID\n"
    )


@pytest.mark.skipif(most_pending() < 2 * SILENT, reason="processes may open few files here")
def test_silent_connections_keep_nobody_out(domain: int) -> None:
    """Zenoh lets 100 of them wait for 10 s, and nobody else in meanwhile."""
    with process(domain, "session.announce('@ros2_lv/0/a/x')" + WAIT), ExitStack() as stack:
        for _ in range(SILENT):
            stack.enter_context(socket.create_connection(("127.0.0.1", FIRST_PORT + domain), PATIENCE))
        begin = time.monotonic()
        with closing(ZenohTransport(domain, environ={})) as session:
            assert session.tokens(GRAPH) == ["@ros2_lv/0/a/x"]
        assert time.monotonic() - begin < 5.0


def test_a_router_that_is_not_there(domain: int) -> None:
    environ = {"ZENOH_CONFIG_OVERRIDE": "connect/timeout_ms=100"}
    with pytest.raises(
        TransportError, match=r"cannot join the network 'tcp/127.0.0.1:9': nobody lets this session in at"
    ):
        ZenohTransport(domain, "tcp/127.0.0.1:9", environ)


def test_an_isolated_session_hears_only_itself(zenoh_net: Network, domain: int) -> None:
    witness, alone = zenoh_net.session(), ZenohTransport(domain, "off", {})
    try:
        alone.announce("@ros2_lv/0/alone")
        ear, outlet = Ear(alone), alone.advertise(CHATTER, PLAIN)
        outlet.put(b"me", b"")
        assert ear.next() == b"me"
        assert alone.tokens(GRAPH) == ["@ros2_lv/0/alone"]
        assert witness.tokens(GRAPH) == []
    finally:
        alone.close()


# ---------------------------------------------------------------- foreign peers


@pytest.fixture
def foreigner(zenoh_net: Network, domain: int) -> Iterator[zenoh.Session]:
    """A bare Zenoh session on the network, such as a node of ROS 2 has."""
    zenoh_net.session()
    session = zenoh.open(network.load(None, domain, {}, holds_port=False))
    yield session
    quietly(session.close)


def test_a_sample_without_an_attachment(zenoh_net: Network, foreigner: zenoh.Session) -> None:
    ear = Ear(zenoh_net.session())
    publisher = foreigner.declare_publisher(CHATTER)
    until(lambda: is_matching(publisher))
    publisher.put(b"bare")
    assert ear.session.read(ear.arrived.get(timeout=PATIENCE)) == (b"bare", b"")


def test_an_error_as_reply(zenoh_net: Network, foreigner: zenoh.Session) -> None:
    def refuse(query: zenoh.Query) -> None:
        query.reply_err(b"out of order")
        quietly(query.drop)

    session = zenoh_net.session()
    with foreigner.declare_queryable(ADD, refuse, complete=True):
        callers: list[Caller] = []

        def answered() -> bool:
            callers.append(Caller(session))
            return callers[-1].arrived.get(timeout=PATIENCE) is not None

        until(answered)
        with pytest.raises(TransportError, match="replied with an error: out of order"):
            Caller(session).replies()


def test_keys_that_zenoh_refuses_are_said_in_one_line(zenoh_net: Network) -> None:
    session = zenoh_net.session()
    with pytest.raises(TransportError, match="empty chunks are forbidden") as caught:
        session.advertise("a//b", PLAIN)
    assert str(caught.value).startswith("a//b: ")
    assert ".rs" not in str(caught.value)


THREADS = """
import subprocess, time
other, deadline, readers = ZenohTransport(int(sys.argv[1]), environ=dict()), time.monotonic() + 10, 0
while readers != int(sys.argv[2]) and time.monotonic() < deadline:  # each names itself when it begins
    time.sleep(0.01)
    names = [open(f"/proc/self/task/{each}/comm").read() for each in os.listdir("/proc/self/task")]
    readers = sum(name.startswith("rx-") for name in names)
print(readers, os.environ.get("ZENOH_RUNTIME"), flush=True)
subprocess.run(["printenv", "ZENOH_RUNTIME"])
"""
"""Program that prints how many threads read its links, and what it sees and hands down of Zenoh's variable."""


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux shows the names of threads")
@pytest.mark.parametrize("chosen", [None, "(rx:(worker_threads:5))"], ids=["by itself", "as the user says"])
def test_enough_threads_read_and_no_other_program_is_told(
    domain: int, chosen: str | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("ZENOH_RUNTIME", raising=False)
    if chosen:
        monkeypatch.setenv("ZENOH_RUNTIME", chosen)
    readers = 5 if chosen else READERS
    done = run(domain, THREADS, str(readers))
    assert done.stdout == f"{readers} {chosen}\n" + (f"{chosen}\n" if chosen else ""), done.stderr
