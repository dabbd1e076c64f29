"""The network `dds`: what the environment requests, and sessions of it over the sockets of this machine."""

from __future__ import annotations

import os
import socket
import statistics
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace

import pytest

from robolink import Context
from robolink.cli.main import main
from robolink.dds import network
from robolink.dds.network import meets, reach_of, refuse_security
from robolink.dds.transport import DdsTransport
from robolink.exceptions import SecurityError, TransportClosedError, TransportError
from robolink.executors import SingleThreadedExecutor
from robolink.extensions import ExtensionError, optional
from robolink.interfaces.std_msgs.msg import String
from robolink.interfaces.std_srvs.srv import SetBool
from robolink.networks import kinds
from robolink.networks.request import NetworkRequest
from robolink.node import Node
from robolink.qos import QoSProfile
from robolink.rtps import Range, Reach
from robolink.transport import connect
from tests.support.domains import free_dds_domain
from tests.support.transports import BEST_EFFORT, GRAPH, KEEP_ALL, PLAIN, Caller, Desk, Ear, find, latched, probe, until

LOCAL = Reach(range=Range.LOCALHOST)


@pytest.fixture
def dds_domain() -> Iterator[int]:
    with free_dds_domain() as number:
        yield number


# ---------------------------------------------------------------- what is requested


@pytest.mark.parametrize(
    ("environ", "expected"),
    [
        ({}, LOCAL),
        ({"ROS_AUTOMATIC_DISCOVERY_RANGE": "localhost"}, LOCAL),
        ({"ROS_AUTOMATIC_DISCOVERY_RANGE": "SYSTEM_DEFAULT", "ROS_STATIC_PEERS": " ; "}, LOCAL),
        ({"ROS_AUTOMATIC_DISCOVERY_RANGE": "OFF", "ROS_STATIC_PEERS": "10.0.0.9"}, Reach(range=Range.OFF)),
        ({"ROS_AUTOMATIC_DISCOVERY_RANGE": "SUBNET"}, Reach("10.0.0.1")),
        ({"ROS_AUTOMATIC_DISCOVERY_RANGE": "SUBNET", "ROBOLINK_DDS_INTERFACE": "eth1"}, Reach("eth1")),
        ({"ROS_STATIC_PEERS": "10.0.0.9;robot"}, Reach("10.0.0.1", ("10.0.0.9", "robot"), Range.LOCALHOST)),
        (
            {"ROS_AUTOMATIC_DISCOVERY_RANGE": "SUBNET", "ROS_STATIC_PEERS": "10.0.0.9"},
            Reach("10.0.0.1", ("10.0.0.9",), Range.SUBNET),
        ),
    ],
)
def test_the_environment_says_how_far_it_reaches(
    environ: dict[str, str], expected: Reach, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(network, "_way_to", lambda address: "10.0.0.1")
    assert reach_of(environ) == expected


def test_the_way_to_this_machine_needs_no_interface() -> None:
    assert network._way_to("127.0.0.1") == ""
    assert network._way_to("no such host") == ""


@pytest.mark.parametrize(
    ("up", "expected"), [(["lo", "eth0"], "10.0.0.7"), (["lo", "eth0", "wlan0"], ""), (["lo", "wlan0"], "10.1.0.7")]
)
def test_without_a_route_for_multicast_the_only_interface_is_used(
    up: list[str], expected: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A robot at the end of a cable has none. With several interfaces one must be named."""
    addresses = {"lo": "127.0.0.1", "eth0": "10.0.0.7", "wlan0": "10.1.0.7"}
    found = {name: [SimpleNamespace(family=socket.AF_INET, address=each)] for name, each in addresses.items()}
    monkeypatch.setattr("psutil.net_if_addrs", lambda: found)
    monkeypatch.setattr("psutil.net_if_stats", lambda: {name: SimpleNamespace(isup=name in up) for name in addresses})
    monkeypatch.setattr(network, "_way_to", lambda address: "")
    assert reach_of({"ROS_AUTOMATIC_DISCOVERY_RANGE": "SUBNET"}) == Reach(expected, range=Range.SUBNET)


def test_wrong_settings_are_said_in_one_line() -> None:
    with pytest.raises(TransportError, match=r"ROS_AUTOMATIC_DISCOVERY_RANGE must be one of .*, got 'FARAWAY'"):
        reach_of({"ROS_AUTOMATIC_DISCOVERY_RANGE": "FARAWAY"})
    with pytest.raises(TransportError, match=r"cannot join DDS domain 1: .*no interface 'eth99'.*there are"):
        network.open_session(1, {"ROS_AUTOMATIC_DISCOVERY_RANGE": "SUBNET", "ROBOLINK_DDS_INTERFACE": "eth99"})
    with pytest.raises(TransportError, match="from 0 to 232"):
        network.open_session(300, {})


def test_it_is_refused_where_security_is_on() -> None:
    for ask in (refuse_security, meets, lambda environ: network.open_session(0, environ)):
        with pytest.raises(
            SecurityError, match="ROS_SECURITY_ENABLE is true, and robolink has no security on DDS"
        ) as error:
            ask({"ROS_SECURITY_ENABLE": "true"})
        assert "\n" not in str(error.value)
    refuse_security({"ROS_SECURITY_ENABLE": "true", "ROBOLINK_DDS_UNSECURED": "1"})
    refuse_security({"ROS_SECURITY_ENABLE": "false"})


def test_it_says_whom_it_meets(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(network, "_way_to", lambda address: "10.0.0.1")
    here = "nodes of ROS 2 over DDS on this machine"
    assert meets({}) == f"{here} only"
    assert meets({"ROS_AUTOMATIC_DISCOVERY_RANGE": "OFF"}) == "no other process"
    wide = {"ROS_AUTOMATIC_DISCOVERY_RANGE": "SUBNET", "ROS_STATIC_PEERS": "robot"}
    assert meets(wide) == f"{here} and those that multicast reaches on 10.0.0.1 and those at robot"


def test_the_registry_has_it_and_looks_no_further_for_zenohs_networks(monkeypatch: pytest.MonkeyPatch) -> None:
    assert kinds.kind_of(NetworkRequest("", "dds")) is not None
    assert kinds.kind_of(NetworkRequest("", "nobody_has_this")) is None
    monkeypatch.setattr(kinds, "NETWORKS", None)
    for value in ("localhost", "lan", "subnet", "off", "10.0.0.1", "robot.local", "tcp/robot:7447", "a.json5", "Robot"):
        assert kinds.kind_of(NetworkRequest("", value)) is None


def test_an_installation_without_it_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(optional, "is_here", lambda target: False)
    with pytest.raises(optional.MissingPartError, match="the network 'dds' is not part of this installation"):
        connect("zenoh://", network="dds")


def test_a_network_of_another_package_that_is_broken_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(name: str) -> None:
        raise ExtensionError(f"robolink-can adds '{name}'")

    monkeypatch.setattr(kinds.NETWORKS, "get", broken)
    with pytest.raises(ExtensionError, match="adds 'can'"):
        connect("zenoh://", network="can")


LAUNCH = "network: dds\nnodes: [{node: demo_nodes_py talker}]\n"


@pytest.mark.parametrize("by_option", [True, False], ids=["by the option", "by the launch file"])
def test_a_launch_file_is_refused_in_one_line_before_anything_starts(
    by_option: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    for name, value in (("ROBOLINK_NETWORK", ""), ("ROBOLINK_NETWORK_ASKED_BY", ""), ("ROS_SECURITY_ENABLE", "")):
        monkeypatch.setenv(name, value)  # what the command sets is undone
    monkeypatch.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "nowhere")
    file = tmp_path / "system.yaml"
    file.write_text(LAUNCH.partition("\n")[2] if by_option else LAUNCH, encoding="utf-8")
    assert main([*(["--network", "dds"] if by_option else []), "launch", str(file)]) == 1
    assert capsys.readouterr().err == (
        "robolink: ROS_AUTOMATIC_DISCOVERY_RANGE must be one of SYSTEM_DEFAULT, LOCALHOST, SUBNET, OFF, got 'nowhere'\n"
    )


# ---------------------------------------------------------------- sessions over sockets


def test_participants_on_this_machine_are_counted_by_their_ports(dds_domain: int) -> None:
    assert network.count_here(dds_domain) == 0
    sessions = [network.open_session(dds_domain, {}) for _ in range(3)]
    assert network.count_here(dds_domain) == 3
    for session in sessions:
        session.close()
    until(lambda: network.count_here(dds_domain) == 0)
    assert network.count_here(232) == 0  # where the ports end


def test_it_is_chosen_by_argument_or_variable(dds_domain: int, monkeypatch: pytest.MonkeyPatch) -> None:
    by_argument = connect("zenoh://", dds_domain, network="dds")
    monkeypatch.setenv("ROBOLINK_NETWORK", "dds")
    by_variable = connect("zenoh", dds_domain)
    try:
        assert [each.url for each in (by_argument, by_variable)] == ["dds://", "dds://"]
        assert isinstance(by_variable, DdsTransport)
        assert by_argument.session_id != by_variable.session_id
    finally:
        by_argument.close()
        by_variable.close()


@pytest.mark.parametrize("published", [PLAIN, BEST_EFFORT, latched(2)], ids=["plain", "best effort", "latched"])
@pytest.mark.parametrize("subscribed", [KEEP_ALL, BEST_EFFORT, latched(2)], ids=["keep all", "best effort", "latched"])
def test_every_pair_of_profiles_talks(dds_domain: int, published: QoSProfile, subscribed: QoSProfile) -> None:
    sessions = [network.open_session(dds_domain, {}) for _ in range(2)]
    ear, outlet = Ear(sessions[0], qos=subscribed), sessions[1].advertise(TALK, published)
    until(lambda: probe(outlet, ear))
    outlet.put(b"some", b"")
    outlet.put(bytes(300_000), b"")
    assert {*ear.until(b"some")} <= {b"probe\0\0\0"}  # in multiples of four
    assert ear.next() == bytes(300_000)
    for session in sessions:
        session.close()


TALK = "0/chatter/std_msgs::msg::dds_::String_/TypeHashNotSupported"


def test_a_new_session_knows_what_was_there_and_leaves_at_once(dds_domain: int) -> None:
    contexts = [Context(transport=network.open_session(dds_domain, {})) for _ in range(5)]
    for context in contexts:
        context.init([], domain_id=dds_domain)
    nodes = [Node(f"node{number}", context=context) for number, context in enumerate(contexts)]
    newcomer = network.open_session(dds_domain, {})
    begin = time.monotonic()
    listed = newcomer.tokens(GRAPH.replace("/0/", f"/{dds_domain}/"))
    assert time.monotonic() - begin < 2.0
    assert sum("/NN/" in each for each in listed) == 5
    assert sum("/SS/" in each for each in listed) == 7 * len(nodes)
    took = []
    for leave in (newcomer.close, *(each.shutdown for each in contexts)):
        begin = time.monotonic()
        leave()
        took.append(time.monotonic() - begin)
    assert min(took) < 0.2, "each waits for something, as on a busy machine only some do"


def test_calls_need_no_other_reason_to_wake_an_executor(dds_domain: int) -> None:
    """A spin of rclpy's has no period of its own: an answer that only its next look finds comes 0.25 s late here."""
    contexts = [Context(transport=network.open_session(dds_domain, {})) for _ in range(2)]
    nodes, executors = [], []
    for number, context in enumerate(contexts):
        context.init([], domain_id=dds_domain)
        nodes.append(Node(f"node{number}", context=context, start_parameter_services=False))
        executors.append(SingleThreadedExecutor(context=context))
        executors[-1].add_node(nodes[-1])
    caller, server = nodes
    server.create_service(SetBool, "set", lambda request, response: SetBool.Response(success=request.data))
    heard = threading.Event()
    echo = server.create_publisher(String, "echo", 10)
    server.create_subscription(String, "say", echo.publish, 10)
    caller.create_subscription(String, "echo", lambda message: heard.set(), 10)
    say, client = caller.create_publisher(String, "say", 10), caller.create_client(SetBool, "set")
    threads = [threading.Thread(target=executor.spin) for executor in executors]
    for thread in threads:
        thread.start()
    assert client.wait_for_service(10.0)
    until(lambda: say.get_subscription_count() > 0 and caller.count_publishers("echo") > 0)

    def called() -> None:
        assert client.call(SetBool.Request(data=True), 10.0).success

    def echoed() -> None:
        heard.clear()
        say.publish(String(data="x"))
        assert heard.wait(10.0)

    until(lambda: say.get_subscription_count() > 0)
    took = {what: statistics.median(timed(what) for _ in range(40)) for what in (called, echoed)}
    for executor, context in zip(executors, contexts, strict=True):
        executor.shutdown()
        context.shutdown()
    for thread in threads:
        thread.join(10.0)
    assert took[called] < max(0.02, 5 * took[echoed])


def timed(what: object) -> float:
    assert callable(what)
    begin = time.perf_counter()
    what()
    return time.perf_counter() - begin


def test_a_caller_that_belongs_to_no_node_finds_the_servers(dds_domain: int) -> None:
    sessions = [network.open_session(dds_domain, {}) for _ in range(2)]
    desk = Desk(sessions[0])
    find(sessions[1], desk)
    caller = Caller(sessions[1], b"some")
    query = desk.next()
    query.reply(query.payload * 2, b"")
    assert caller.answers() == [b"somesome"]
    for session in sessions:
        session.close()


FORK = """
import os, sys, warnings
from robolink.dds.network import open_session
from robolink.qos import QoSProfile

warnings.simplefilter("ignore")
domain = int(sys.argv[1])
session = open_session(domain, {})
outlet = session.advertise("0/chatter/std_msgs::msg::dds_::String_/TypeHashNotSupported", QoSProfile(depth=1))
outlet.put(b"1234", b"")
child = os.fork()
if child:
    _, status = os.waitpid(child, 0)
    outlet.put(b"1234", b"")
    print("parent", os.waitstatus_to_exitcode(status), flush=True)
    sys.exit()
for use in (lambda: outlet.put(b"1234", b""), lambda: session.announce("t"), lambda: session.tokens("**")):
    try:
        use()
    except ConnectionError as error:
        print("spawn" in str(error), flush=True)
session.close()
own = open_session(domain, {})  # its threads are its own
own.advertise("0/chatter/std_msgs::msg::dds_::String_/TypeHashNotSupported", QoSProfile(depth=1)).put(b"1234", b"")
own.close()
print("own", flush=True)
sys.exit(5)
"""


@pytest.mark.processes
@pytest.mark.skipif(not hasattr(os, "fork"), reason="Windows cannot fork")
def test_a_forked_child_is_told_and_may_begin_anew(dds_domain: int) -> None:
    command = [sys.executable, "-c", FORK, str(dds_domain)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=30, check=False)
    assert done.stdout.splitlines() == ["True", "True", "True", "own", "parent 5"], done.stderr


ENDING = """
import sys, threading, time
from robolink.dds.network import open_session
from robolink.qos import QoSProfile

KEY = "0/chatter/std_msgs::msg::dds_::String_/TypeHashNotSupported"
session, stranger = (open_session(int(sys.argv[1]), {}) for _ in range(2))
outlet, came = session.advertise(KEY, QoSProfile(depth=1)), threading.Event()
stranger.subscribe(KEY, QoSProfile(depth=1), lambda arrived: came.set())
session.watch("**", lambda token, alive: None)


def flood():
    while True:
        outlet.put(bytes(1000), b"")


threading.Thread(target=flood, daemon=True).start()
came.wait(10)
sys.exit(3)
"""


@pytest.mark.processes
def test_the_interpreter_exits_with_sessions_left_open(dds_domain: int) -> None:
    command = [sys.executable, "-c", ENDING, str(dds_domain)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=30, check=False)
    assert (done.returncode, done.stderr) == (3, "")


def test_what_is_closed_says_so(dds_domain: int) -> None:
    session = network.open_session(dds_domain, {})
    session.close()
    session.close()
    with pytest.raises(TransportClosedError, match="has been closed"):
        session.tokens(GRAPH)
