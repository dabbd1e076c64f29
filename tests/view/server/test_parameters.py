"""Parameters for clients: from a cache that no silent node can stall, set by type, with the node's reason."""

from __future__ import annotations

import asyncio
import json
from collections import deque
from collections.abc import Callable
from typing import Any, cast

import pytest

from robolink import Node
from robolink.interfaces.rcl_interfaces.msg import (
    FloatingPointRange,
    Parameter,
    ParameterDescriptor,
    ParameterEvent,
    ParameterType,
    ParameterValue,
)
from robolink.interfaces.rcl_interfaces.srv import GetParameters, ListParameters
from robolink.message import encode
from robolink.parameter import Parameter as RosParameter
from robolink.view.protocol.requests import LONGEST_LIST
from robolink.view.server.parameters import MOST_ROUNDS, Parameters
from robolink.view.sources.live import LiveSource
from tests.support.view_clients import Client, Shown, shown


def with_parameters(system: Shown) -> None:
    limits = ParameterDescriptor(floating_point_range=[FloatingPointRange(from_value=0.0, to_value=1.0)])
    system.node.declare_parameter("speed", 0.5, limits)
    system.node.declare_parameter("count", 3)
    system.node.declare_parameter("names", ["a", "b"])
    system.node.declare_parameter("gains", [1.0, 2.0])
    system.node.declare_parameter("raw", [b"\x01", b"\xff"])


def values(told: dict[str, Any]) -> dict[str, Any]:
    return {each["name"]: each.get("value") for each in told["parameters"]}


def get(client: Client, names: list[str], id_: str = "q") -> dict[str, Any]:
    client.send("getParameters", parameterNames=names, id=id_)
    return values(client.wait_for("parameterValues", id=id_))


def known(client: Client, name: str) -> dict[str, Any]:
    """Ask until the server knows a node's parameters."""
    while True:
        found = get(client, [])
        if name in found:
            return found


@pytest.mark.parametrize("subprotocol", ["robolink.v1", "foxglove.sdk.v1", "foxglove.websocket.v1"])
def test_all_parameters_of_all_nodes(subprotocol: str) -> None:
    with shown() as system:
        with_parameters(system)
        with system.spinning(), system.client(subprotocol) as client:
            found = known(client, "/robot.speed")
            assert found["/robot.speed"] == 0.5
            assert found["/robot.count"] == 3
            assert found["/robot.names"] == ["a", "b"]
            assert found["/robot.raw"] == "Af8="
            client.send("getParameters", parameterNames=["/robot.speed"], id="typed")
            assert client.wait_for("parameterValues", id="typed")["parameters"] == [
                {"name": "/robot.speed", "value": 0.5, "type": "float64"}
            ]


def test_a_parameter_is_set_by_its_own_type_and_followers_hear_of_it() -> None:
    with shown() as system:
        with_parameters(system)
        with system.spinning() as node, system.client() as client, system.client("foxglove.sdk.v1") as other:
            other.send("subscribeParameterUpdates", parameterNames=["/robot.speed"])
            other.settle()
            wishes = [
                {"name": "/robot.speed", "value": 1},
                {"name": "/robot.gains", "value": [3, 4]},
                {"name": "/robot.raw", "value": "AAE=", "type": "byte_array"},
            ]
            client.send("setParameters", parameters=wishes, id="set")
            told = values(client.wait_for("parameterValues", id="set"))
            assert told == {"/robot.speed": 1.0, "/robot.gains": [3.0, 4.0], "/robot.raw": "AAE="}
            assert node.get_parameter("speed").value == 1.0
            while values(other.wait_for("parameterValues")) != {"/robot.speed": 1.0}:
                pass


@pytest.mark.parametrize("id_", [None, "set"])
def test_a_follower_that_sets_a_parameter_is_told_once(id_: str | None) -> None:
    with shown() as system:
        with_parameters(system)
        with system.spinning(), system.client("foxglove.sdk.v1") as client:
            known(client, "/robot.count")
            client.send("subscribeParameterUpdates", parameterNames=["/robot.count"])
            named = {} if id_ is None else {"id": id_}
            client.send("setParameters", parameters=[{"name": "/robot.count", "value": 7}], **named)
            assert values(client.wait_for("parameterValues", **named)) == {"/robot.count": 7}
            system.node.set_parameters([RosParameter("count", value=9)])
            assert values(client.wait_for("parameterValues")) == {"/robot.count": 9}  # and nothing came between


def test_names_without_a_value_are_left_out() -> None:
    with shown() as system:
        with_parameters(system)
        with system.spinning(), system.client("foxglove.sdk.v1") as client:
            assert get(client, ["/robot.count", "/nobody.x"]) == {"/robot.count": 3}


class Slow:
    """A system of one node `/n`, whose answers a test gives."""

    def __init__(self) -> None:
        self.followers: list[Callable[[], object]] = []
        self.caller = self
        self.asked: deque[tuple[str, asyncio.Future[bytes]]] = deque()
        self.nodes = {"/n"}

    async def call(self, name: str, cls: type[Any], request: bytes, within: float) -> bytes:
        answer: asyncio.Future[bytes] = asyncio.get_running_loop().create_future()
        self.asked.append((name.rpartition("/")[2], answer))
        return await answer

    async def answer(self, service: str, message: Any) -> None:
        """Answer the oldest question, once it was asked."""
        while not self.asked:
            await asyncio.sleep(0)
        asked, answer = self.asked.popleft()
        assert asked == service
        answer.set_result(encode(message))

    async def answer_x(self, number: int) -> None:
        await self.answer("get_parameters", GetParameters.Response(values=[integer(number)]))

    async def answer_names(self) -> None:
        response = ListParameters.Response()
        response.result.names = ["x"]
        await self.answer("list_parameters", response)

    def service_names(self) -> set[str]:
        return {f"{node}/get_parameters" for node in self.nodes}

    def serves(self, name: str) -> bool:
        return name in self.service_names()

    def channel_of(self, topic: str) -> None:
        return None


class Told:
    """A client that keeps what it is told."""

    is_page = True

    def __init__(self) -> None:
        self.heard: list[dict[str, Any]] = []

    def say(self, text: str) -> None:
        self.heard.append(json.loads(text))

    def send(self, body: bytes) -> None:
        raise AssertionError(body)

    def complain(self, message: str, level: int = 2) -> None:
        raise AssertionError(message)

    @property
    def last(self) -> Any:
        return values(self.heard[-1])["/n.x"]


def integer(number: int) -> ParameterValue:
    return ParameterValue(type=ParameterType.PARAMETER_INTEGER, integer_value=number)


def changed(number: int) -> bytes:
    return encode(ParameterEvent(node="/n", changed_parameters=[Parameter(name="x", value=integer(number))]))


def of(system: Slow) -> Parameters:
    return Parameters(cast(LiveSource, system))


def test_a_change_while_a_node_is_asked_first_is_not_lost() -> None:
    async def run() -> None:
        system, client = Slow(), Told()
        parameters = of(system)
        parameters.follow(client, [])
        await system.answer_names()
        while not system.asked:
            await asyncio.sleep(0)
        parameters._on_event(0, changed(2), b"")  # heard before the answer of before it
        await system.answer_x(1)
        await system.answer_names()
        await system.answer_x(2)
        while not client.heard:
            await asyncio.sleep(0)
        assert client.last == 2

    asyncio.run(run())


def test_a_change_while_a_parameter_is_read_again_is_not_lost() -> None:
    async def run() -> None:
        system, client = Slow(), Told()
        parameters = of(system)
        parameters.follow(client, [])
        await system.answer_names()
        await system.answer_x(1)
        while not client.heard:
            await asyncio.sleep(0)
        reading = asyncio.ensure_future(parameters.get(client, ["/n.x"], "q"))
        while not system.asked:
            await asyncio.sleep(0)
        parameters._on_event(0, changed(2), b"")
        await system.answer_x(1)
        await system.answer_x(2)
        await reading
        assert client.last == 2

    asyncio.run(run())


def test_a_node_that_changes_without_end_is_asked_a_few_times() -> None:
    async def run() -> None:
        system, client = Slow(), Told()
        parameters = of(system)
        parameters.follow(client, [])
        for number in range(MOST_ROUNDS):
            await system.answer_names()
            while not system.asked:
                await asyncio.sleep(0)
            parameters._on_event(0, changed(number), b"")
            await system.answer_x(number)
        while not client.heard:
            await asyncio.sleep(0)
        assert (client.last, len(system.asked)) == (MOST_ROUNDS - 1, 0)

    asyncio.run(run())


def test_a_node_that_comes_back_while_it_was_asked_is_asked_anew() -> None:
    async def run() -> None:
        system, client = Slow(), Told()
        parameters = of(system)
        parameters.follow(client, [])
        while not system.asked:
            await asyncio.sleep(0)
        for nodes in (set[str](), {"/n"}, {"/n"}):  # and the one that asked before ends after that
            system.nodes = nodes
            for look in system.followers:
                look()
        system.asked.popleft()
        await system.answer_names()
        await system.answer_x(5)
        while not client.heard:
            await asyncio.sleep(0)
        for look in system.followers:
            look()
        assert (client.last, len(system.asked)) == (5, 0)

    asyncio.run(run())


def test_the_nodes_reason_is_told() -> None:
    with shown() as system:
        with_parameters(system)
        with system.spinning() as node, system.client() as client:
            client.send("setParameters", parameters=[{"name": "/robot.speed", "value": 7.0}], id="set")
            told = client.wait_for("status", level=2)["message"]
            assert told.startswith("/robot.speed is not set: ")
            assert values(client.wait_for("parameterValues", id="set")) == {"/robot.speed": 0.5}
            assert node.get_parameter("speed").value == 0.5


@pytest.mark.slow
def test_a_node_that_does_not_answer_stalls_nothing() -> None:
    with shown() as system:
        with_parameters(system)
        frozen = Node("frozen", context=system.new_context())  # nobody spins it
        frozen.declare_parameter("x", 1)
        with system.spinning(), system.client() as client:
            assert "/robot.speed" in known(client, "/robot.speed")
            assert get(client, ["/robot.count"]) == {"/robot.count": 3}
            client.send("getParameters", parameterNames=["/frozen.x", "/robot.count"], id="both")
            client.settle()  # others go on meanwhile
            assert not [each for each in client.heard if each.get("id") == "both"]
            assert values(client.wait_for("parameterValues", id="both"))["/robot.count"] == 3
            assert "no answer within 2 s" in client.wait_for("status")["message"]
        frozen.context.try_shutdown()


def test_thousands_of_names_are_one_answer_and_nobody_waits_for_it() -> None:
    with shown() as system:
        with_parameters(system)
        with system.spinning(), system.client() as client:
            known(client, "/robot.speed")
            names = [f"/n{number}.x" for number in range(LONGEST_LIST - 1)]
            for op in ("getParameters", "setParameters"):
                wishes = [{"name": name, "value": 1} for name in names]
                more = {"parameterNames": [*names, "/robot.count"]} if op == "getParameters" else {"parameters": wishes}
                client.send(op, id=op, **more)
                told = client.wait_for("parameterValues", id=op)["parameters"]
                there = [{"name": "/robot.count", "value": 3}] if op == "getParameters" else []
                assert [each for each in told if "value" in each] == there
                message = client.wait_for("status", level=1)["message"]
                assert message == f"parameters of /n0: there is no such node; nor are {len(names) - 1} others"


@pytest.mark.parametrize(
    ("name", "value", "why"),
    [
        ("/robot.speed", {"a": 1}, "not a value of a parameter"),
        ("/robot.names", ["a", 1], "of one type"),
        ("/robot.count", 2**70, "64 bits"),
        ("robot", 1, "names no parameter"),
        ("/robto.speed", 1, "did you mean"),
    ],
)
def test_what_cannot_be_set_is_refused(name: str, value: Any, why: str) -> None:
    with shown() as system:
        with_parameters(system)
        with system.spinning(), system.client() as client:
            known(client, "/robot.speed")
            client.send("setParameters", parameters=[{"name": name, "value": value}])
            assert why in client.wait_for("status")["message"]
