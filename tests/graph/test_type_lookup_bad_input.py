"""What a node says of its types is not trusted: any answer makes the right type, or an error of one line."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from robolink import Context, Node, Parameter
from robolink.exceptions import ExternalShutdownException
from robolink.interfaces.type_description_interfaces.msg import Field, FieldType
from robolink.interfaces.type_description_interfaces.srv import GetTypeDescription
from robolink.message import type_name
from robolink.message.description import described, to_message
from robolink.type_lookup import TypeLookupError, type_of
from robolink.wire import NO_HASH, EndpointKind, EndpointToken
from tests.support.carts import Cart, Wheel, seen
from tests.support.seen_by_commands import a_node_that_commands_see, spinning

Answer = Callable[[Any, Any], Any]
QUIET = [Parameter("start_type_description_service", value=False)]


@pytest.fixture
def robot(monkeypatch: pytest.MonkeyPatch) -> Iterator[Node]:
    """The node /lab/robot, which nobody spins yet."""
    with a_node_that_commands_see(monkeypatch) as node:
        yield node


@pytest.fixture
def looker(robot: Node) -> Iterator[Context]:
    """A context that shares nothing with the robot's but the network."""
    context = Context()
    context.init([])
    with context:
        yield context


def answering(robot: Node, answer: Answer) -> Node:
    """A node with a publisher of carts that answers in its own way."""
    node = Node("liar", context=robot.context, parameter_overrides=QUIET)
    node.create_publisher(Cart, "cart", 10)
    node.create_service(GetTypeDescription, "~/get_type_description", answer)
    return node


def with_description(change: Callable[[Any], Any]) -> Answer:
    """Answer with the description of the cart after a change."""

    def answer(_: Any, response: Any) -> Any:
        response.successful = True
        response.type_description = to_message(described(Cart))
        change(response.type_description)
        return response

    return answer


def renamed(description: Any) -> None:
    description.type_description.fields[1].name = "lable"


def cyclic(description: Any) -> None:
    wheel = description.referenced_type_descriptions[0]
    wheel.fields.append(Field(name="cart", type=FieldType(type_id=1, nested_type_name=type_name(Cart))))


def code(description: Any) -> None:
    description.type_description.fields[1].name = "x; import os; os._exit(3)"


def huge(description: Any) -> None:
    description.type_description.fields = [Field(name=f"f{n}", type=FieldType(type_id=2)) for n in range(30_000)]


def another(description: Any) -> None:
    description.type_description.type_name = "other_msgs/msg/Cart"


def emptied(description: Any) -> None:
    description.type_description.type_name = ""
    description.type_description.fields = []
    description.referenced_type_descriptions = []


HOSTILE = [(change, humble) for change in (cyclic, code, huge, another, emptied) for humble in (False, True)]


@pytest.mark.slow
@pytest.mark.parametrize(("change", "humble"), [(renamed, False), *HOSTILE])
def test_a_hostile_description_is_an_error_of_one_line(
    robot: Node, looker: Context, change: Callable[[Any], Any], humble: bool
) -> None:
    liar = answering(robot, with_description(change))
    token = seen(looker, "/cart")
    with spinning(liar), pytest.raises(TypeLookupError, match=r"\(/liar: .*\)") as caught:
        type_of(looker, token._replace(type_hash=NO_HASH) if humble else token)
    assert str(caught.value).isprintable()
    assert len(str(caught.value)) < 700


def test_what_a_stranger_says_is_fit_for_a_terminal(robot: Node, looker: Context) -> None:
    def answer(_: Any, response: Any) -> Any:
        response.failure_reason = "\x1b[2J\n" * 1000
        return response

    with spinning(answering(robot, answer)), pytest.raises(TypeLookupError) as caught:
        type_of(looker, seen(looker, "/cart"))
    assert r"refused: \x1b[2J\n\x1b[2J" in str(caught.value)
    assert str(caught.value).isprintable()
    assert len(str(caught.value)) < 700


def test_a_refusal_without_a_hash_says_that_there_was_none(robot: Node, looker: Context) -> None:
    """As rcl answers of the type of a service over DDS."""

    def answer(request: Any, response: Any) -> Any:
        response.failure_reason = "" if request.type_hash else "Failed to parse type hash"
        return response

    with spinning(answering(robot, answer)), pytest.raises(TypeLookupError) as caught:
        type_of(looker, seen(looker, "/cart")._replace(type_hash=NO_HASH))
    said = "refused without the type's hash, which is not announced: Failed to parse type hash"
    assert said in str(caught.value)


def test_ctrl_c_is_no_answer_of_a_node(robot: Node, looker: Context) -> None:
    def answer(_: Any, response: Any) -> Any:
        looker.interrupt()
        return response

    with spinning(answering(robot, answer)), pytest.raises(ExternalShutdownException):
        type_of(looker, seen(looker, "/cart"))


def test_a_message_is_not_taken_for_a_service(robot: Node, looker: Context) -> None:
    robot.create_publisher(Cart, "/cart", 10)
    token = seen(looker, "/cart")._replace(kind=EndpointKind.SERVICE)
    with spinning(robot), pytest.raises(TypeLookupError, match="a message as a service"):
        type_of(looker, token)


FIELD_TYPES = st.builds(
    FieldType,
    type_id=st.integers(0, 255) | st.sampled_from([1, 11, 17, 49, 97, 145, 161]),
    capacity=st.integers(0, 2**64 - 1) | st.integers(0, 3),
    string_capacity=st.integers(0, 2**64 - 1) | st.integers(0, 3),
    nested_type_name=st.sampled_from(["", type_name(Cart), type_name(Wheel), "a/msg/B", "/", "os/msg/System"]),
)
FIELDS = st.builds(
    Field, name=st.text(max_size=8) | st.sampled_from("abc"), type=FIELD_TYPES, default_value=st.text(max_size=8)
)


@pytest.mark.slow
@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.lists(FIELDS, max_size=4), st.lists(FIELDS, max_size=3))
def test_any_description_makes_a_type_or_an_error_of_one_line(
    robot: Node, looker: Context, monkeypatch: pytest.MonkeyPatch, fields: list[Any], nested: list[Any]
) -> None:
    def change(description: Any) -> None:
        description.type_description.fields = fields
        description.referenced_type_descriptions[0].fields = nested

    answer = with_description(change)(None, GetTypeDescription.Response())
    monkeypatch.setattr("robolink.client.Client.try_call", lambda *_, **__: answer)
    robot.create_publisher(Cart, "/cart", 10)
    token = seen(looker, "/cart")
    assert said(looker, token).isprintable()
    assert said(looker, token._replace(type_hash=NO_HASH)).isprintable()


def said(context: Context, token: EndpointToken) -> str:
    try:
        return type_of(context, token).__name__
    except TypeLookupError as error:
        return str(error)
