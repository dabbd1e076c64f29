"""The services of a node's parameters are one declaration in a session, and are called and ended one by one."""

from __future__ import annotations

import contextlib
import threading
from pathlib import PurePosixPath
from typing import Any

import pytest

from robolink import Context, Node
from robolink.executors import SingleThreadedExecutor
from robolink.interfaces.rcl_interfaces.msg import Parameter as ParameterMsg
from robolink.interfaces.rcl_interfaces.msg import ParameterType, ParameterValue
from robolink.interfaces.rcl_interfaces.srv import SetParameters
from robolink.message import decoder, encoder
from robolink.networks.request import FIRST_PORT, OVERRIDE
from robolink.transport import Transport, zenoh_declare
from robolink.transport.base import Sink
from robolink.transport.zenoh import ZenohTransport
from robolink.transport.zenoh_groups import Groups, group_of
from tests.support.ros2_peer import Peer, Type
from tests.support.transports import ADD, Caller, Desk, Network, served, until


def key_of(service: str, node: str = "robot") -> str:
    return f"0/{node}/{service}/rcl_interfaces::srv::dds_::{service.title().replace('_', '')}_/RIHS01_{'0' * 64}"


GET, SET, LIST = map(key_of, ("get_parameters", "set_parameters", "list_parameters"))


class Call:
    """A call as Zenoh hands it over, as far as groups look at it."""

    def __init__(self, key: str) -> None:
        self.key_expr = key


class Declarations:
    """What is declared, each with its sink."""

    def __init__(self) -> None:
        self.groups: dict[str, Sink] = {}
        self.count = 0

    def __call__(self, group: str, sink: Sink) -> Any:
        self.groups[group] = sink
        self.count += 1
        return _Declared(self.groups, group)


class _Declared:
    def __init__(self, groups: dict[str, Sink], group: str) -> None:
        self._groups, self._group = groups, group

    def close(self) -> None:
        del self._groups[self._group]


def test_services_of_one_node_are_declared_once_until_the_last_has_ended() -> None:
    groups, declared = Groups(), Declarations()
    arrived = dict[str, list[Any]]()
    handles = [groups.serve(key, arrived.setdefault(key, []).append, declared) for key in (GET, SET, LIST)]
    assert declared.count == 1
    (sink,) = declared.groups.values()
    calls = [Call(key) for key in (SET, LIST, GET, key_of("of_another_session"))]
    for call in calls:
        sink(call)
    assert arrived == {SET: calls[:1], LIST: calls[1:2], GET: calls[2:3]}
    ended: list[Any] = [*handles[:2], handles[0]]  # one of them twice
    for handle in ended:
        handle.close()
        assert declared.groups
    last: Any = handles[2]
    last.close()
    assert not declared.groups
    sink(Call(GET))  # one that was under way
    assert len(arrived[GET]) == 1
    assert groups.serve(GET, arrived[GET].append, declared) is not None
    assert declared.count == 2


def test_what_is_served_twice_and_what_has_no_group_is_declared_by_itself() -> None:
    groups, declared = Groups(), Declarations()
    assert groups.serve(GET, print, declared) is not None
    assert groups.serve(GET, print, declared) is None
    assert groups.serve(ADD, print, declared) is None
    assert groups.serve("0/short", print, declared) is None
    assert len(declared.groups) == 1


def test_another_node_has_another_group() -> None:
    assert group_of(GET) == group_of(LIST) != group_of(key_of("get_parameters", node="ns/robot"))
    assert group_of(key_of("get_parameters", node="ns/robot")).startswith("0/ns/robot/*/")


# With every transport


def answers(desk: Desk, caller: Caller, payload: bytes) -> list[bytes]:
    query = desk.next()
    query.reply(payload, b"")
    query.close()
    return caller.answers()


@pytest.mark.unlike_dds("keys are ROS 2's there")
@pytest.mark.parametrize("place", ["the same session", "another session"])
def test_each_service_of_a_node_answers_its_calls_whoever_serves_the_others(net: Network, place: str) -> None:
    one, other = net.session(), net.session()
    desks = {GET: Desk(one, GET), SET: Desk(one, SET), LIST: Desk(other, LIST)}
    caller = one if place == "the same session" else net.session()
    for key, desk in desks.items():
        find_at(caller, desk, key)
    for key, desk in desks.items():
        assert answers(desk, Caller(caller, b"", key), key.encode()) == [key.encode()]
    desks[GET].handle.close()
    until(lambda: Caller(caller, b"find", GET).answers() == [])
    assert answers(desks[SET], Caller(caller, b"", SET), b"still") == [b"still"]
    desks[SET].handle.close()
    until(lambda: Caller(caller, b"find", SET).answers() == [])


@pytest.mark.unlike_dds("keys are ROS 2's there")
def test_two_nodes_of_one_name_in_a_session_are_both_called(net: Network) -> None:
    session, caller = net.session(), net.session()
    first, second = Desk(session, GET), Desk(session, GET)
    find_at(caller, first, GET)
    find_at(caller, second, GET)
    call = Caller(caller, b"", GET)
    for number, desk in enumerate((first, second)):
        query = desk.next()
        query.reply(b"%d" % number, b"")
        query.close()
    assert sorted(call.answers()) == [b"0", b"1"]


@pytest.mark.parametrize(
    ("environ", "number"),
    [({}, 1), ({OVERRIDE: "timestamping/enabled=true"}, 2)],
    ids=["settings of our own", "settings of the user's"],
)
def test_a_group_is_declared_only_where_no_setting_of_the_user_names_keys(
    environ: dict[str, str], number: int, domain: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    declared = list[str]()
    declare_server = zenoh_declare.declare_server

    def declare(session: Any, key: str, gate: Sink) -> Any:
        declared.append(key)
        return declare_server(session, key, gate)

    monkeypatch.setattr(zenoh_declare, "declare_server", declare)
    with contextlib.closing(ZenohTransport(domain, environ=environ)) as session:
        desks = [Desk(session, GET), Desk(session, SET)]
        for desk, key in zip(desks, (GET, SET), strict=True):
            find_at(session, desk, key)
        assert len(declared) == number


# Beside ROS 2


def of_node(name: str) -> SetParameters.Request:
    """Return the request that gives a node's parameter `name` its full name."""
    value = ParameterValue(type=ParameterType.PARAMETER_STRING, string_value=name)
    return SetParameters.Request(parameters=[ParameterMsg(name="name", value=value)])


def test_a_client_of_ros_2_finds_each_service_of_nodes_of_similar_names_and_reaches_that_one_alone(domain: int) -> None:
    names = ["/robot", "/robot2", "/ns/robot", "/robot/robot", "/robot/set_parameters"]
    with contextlib.ExitStack() as stack:
        context = Context()
        context.init([], domain_id=domain)
        stack.enter_context(context)
        nodes = [Node(each.name, namespace=str(each.parent), context=context) for each in map(PurePosixPath, names)]
        executor = stack.enter_context(SingleThreadedExecutor(context=context))
        for node in nodes:
            node.declare_parameter("name", "")
            executor.add_node(node)
        spinning = threading.Thread(target=executor.spin)
        stack.callback(spinning.join)
        stack.callback(executor.shutdown)
        spinning.start()
        peer = stack.enter_context(contextlib.closing(Peer(FIRST_PORT + domain, domain)))
        asking = peer.node("asking")
        until(lambda: sum("/SS/" in each and "rcl_interfaces" in each for each in peer.tokens()) == 6 * len(names))
        types = {each.split("/")[-3]: Type(*each.split("/")[-3:-1]) for each in peer.tokens() if "/SS/" in each}
        type_ = types["rcl_interfaces::srv::dds_::SetParameters_"]
        encode = encoder(SetParameters.Request)
        for name in names:
            (reply,) = asking.client(f"{name}/set_parameters", type_).call(encode(of_node(name)))
            assert decoder(SetParameters.Response)(reply.payload).results[0].successful
        assert [each.get_parameter("name").value for each in nodes] == names


def find_at(caller: Transport, desk: Desk, key: str) -> None:
    """Wait until the caller's session knows of the server of this key."""
    until(lambda: served(desk, Caller(caller, b"find", key)))
