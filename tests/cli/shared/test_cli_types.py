"""A type that is not installed is asked of the node that uses it; what the answer cannot be trusted with is refused."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import msgspec
import pytest

from robolink import Context, Node, Parameter, interfaces, type_lookup
from robolink.cli.main import main
from robolink.cli.shared.messages import SeveralTypesError, message_type, service_type
from robolink.exceptions import NotFoundError, RobolinkError
from robolink.interfaces import find_announced
from robolink.interfaces.geometry_msgs.msg import Twist
from robolink.interfaces.std_srvs.srv import Trigger
from robolink.message import Message, Service, string, type_hash, type_name
from robolink.type_lookup import TypeLookupError, type_of
from robolink.wire import NO_HASH
from tests.support.carts import Cart, Haul, Load, Wheel, announced, seen
from tests.support.commands import BUSY_ROBOLINK, Command
from tests.support.seen_by_commands import LATCHED, a_node_that_commands_see, made, spinning

Answer = Callable[[Any, Any], Any]
QUIET = [Parameter("start_type_description_service", value=False)]


@pytest.fixture
def robot(monkeypatch: pytest.MonkeyPatch) -> Iterator[Node]:
    """The node /lab/robot, which nobody spins yet."""
    monkeypatch.setattr(interfaces, "_sources", ())
    monkeypatch.setattr(type_lookup, "ANSWER_WITHIN", 20.0)
    with a_node_that_commands_see(monkeypatch) as node:
        yield node


@pytest.fixture
def looker(robot: Node) -> Iterator[Context]:
    """A context that shares nothing with the robot's but the network."""
    context = Context()
    context.init([])
    with context:
        yield context


# Who is asked.


def test_an_installed_type_is_not_asked_for(robot: Node, looker: Context) -> None:
    robot.create_publisher(Twist, "/cmd_vel", 10)
    assert type_of(looker, seen(looker, "/cmd_vel")) is Twist
    twist, trigger = type_name(Twist), type_name(Trigger)
    assert type_of(looker, announced(looker, "/humble", twist, NO_HASH)) is Twist
    robot.create_client(Trigger, "/reset")
    assert type_of(looker, seen(looker, "/reset")) is Trigger
    assert trigger == "std_srvs/srv/Trigger"


def test_the_node_that_publishes_says_what_its_type_is(robot: Node, looker: Context) -> None:
    robot.create_publisher(Cart, "/cart", 10)
    with spinning(robot):
        found: Any = type_of(looker, seen(looker, "/cart"))
    assert found is not Cart
    assert (found.__ros_type__, type_hash(found)) == (type_name(Cart), type_hash(Cart))
    assert list(found().__ros_fields__) == ["wheels", "label"]
    assert looker.graph.nodes() == robot.context.graph.nodes()  # who asked has gone


def test_services_and_parts_of_actions_too(robot: Node, looker: Context) -> None:
    robot.create_service(Load, "/load", lambda _, response: response)
    robot.create_service(Haul.Impl.SendGoalService, "/haul/_action/send_goal", lambda _, response: response)
    robot.create_publisher(Haul.Impl.FeedbackMessage, "/haul/_action/feedback", 10)
    with spinning(robot):
        service: Any = type_of(looker, seen(looker, "/load"))
        send_goal: Any = type_of(looker, seen(looker, "/haul/_action/send_goal"))
        feedback: Any = type_of(looker, seen(looker, "/haul/_action/feedback"))
    assert issubclass(service, Service)
    assert service.Request().cart.label == ""
    assert type_hash(send_goal) == type_hash(Haul.Impl.SendGoalService)
    assert list(feedback().__ros_fields__) == ["goal_id", "feedback"]


def test_the_installed_parts_of_an_action_are_found(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(interfaces, "_registered", {})
    interfaces.register(Haul)
    for part in (Haul.Impl.SendGoalService, Haul.Impl.GetResultService, Haul.Impl.FeedbackMessage):
        assert find_announced(type_name(part)) is part
    assert find_announced(type_name(Haul)) is Haul
    with pytest.raises(NotFoundError):
        find_announced(type_name(Haul) + "_Request")


def test_another_node_is_asked_when_its_own_cannot_tell(robot: Node, looker: Context) -> None:
    mute = Node("a_mute", context=robot.context, parameter_overrides=QUIET)
    mute.create_publisher(Cart, "/cart", 10)
    robot.create_subscription(Cart, "/elsewhere", lambda _: None, 10)
    with spinning(mute, robot):
        assert type_hash(type_of(looker, seen(looker, "/cart"))) == type_hash(Cart)


def test_a_humble_peers_type_is_asked_for_by_its_name(robot: Node, looker: Context) -> None:
    robot.create_publisher(Cart, "/cart", 10)
    with spinning(robot):
        found = type_of(looker, announced(looker, "/other", type_name(Cart), NO_HASH))
    assert type_hash(found) == type_hash(Cart)


def test_a_type_that_is_another_one_here_is_asked_for(
    robot: Node, looker: Context, monkeypatch: pytest.MonkeyPatch
) -> None:
    class Older(Message, type_name=type_name(Cart)):
        label: string

    monkeypatch.setattr(interfaces, "_registered", {})
    interfaces.register(Older)
    robot.create_publisher(Cart, "/cart", 10)
    with spinning(robot):
        assert type_hash(type_of(looker, seen(looker, "/cart"))) == type_hash(Cart)
        assert type_hash(message_type(looker, "/cart", "Cart")) == type_hash(Cart)
    unknown = announced(looker, "/lost", type_name(Cart), "RIHS01_" + "1" * 64)
    with pytest.raises(TypeLookupError) as caught:
        type_of(looker, unknown)
    assert "has another carts/msg/Cart than is installed (RIHS01_11111111 there, " in str(caught.value)
    assert "bring interfaces/carts/msg/Cart.msg up to date" in str(caught.value)


# When nobody can tell.


def test_it_says_what_to_do_when_nobody_serves_it(robot: Node, looker: Context) -> None:
    token = announced(looker, "/lost", "zoo_msgs/srv/Feed", "RIHS01_" + "1" * 64)
    with pytest.raises(TypeLookupError) as caught:
        type_of(looker, token)
    assert str(caught.value) == (
        "/lost has the type zoo_msgs/srv/Feed, which is not installed, and no node tells what it is (/lab/keeper: it"
        " does not serve get_type_description): put interfaces/zoo_msgs/srv/Feed.srv into your workspace"
    )
    assert isinstance(caught.value, LookupError)


def test_a_node_that_does_not_spin_is_not_waited_for_long(
    robot: Node, looker: Context, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(type_lookup, "ANSWER_WITHIN", 0.05)
    robot.create_publisher(Cart, "/cart", 10)
    with pytest.raises(TypeLookupError, match=r"/lab/robot: .*no answer within 0.05 s"):
        type_of(looker, seen(looker, "/cart"))


@pytest.mark.parametrize("type_", ["a/B", "a/b/c/D", "a/msg/B_C", "a/action/B_SendGoal", "a/idl/B"])
def test_odd_names_of_types_are_errors_of_one_line(robot: Node, looker: Context, type_: str) -> None:
    with pytest.raises(RobolinkError) as caught:
        type_of(looker, announced(looker, "/odd", type_, "RIHS01_" + "1" * 64))
    assert "\n" not in str(caught.value)
    with pytest.raises(RobolinkError):
        message_type(looker, "/odd", "Unknown")


# What commands use for a topic or service.


def test_the_type_of_a_topic(robot: Node, looker: Context) -> None:
    robot.create_subscription(Twist, "/cmd_vel", lambda _: None, 10)
    assert message_type(looker, "/cmd_vel") is Twist
    assert message_type(looker, "/anything", "Twist") is Twist
    with pytest.raises(NotFoundError, match=r"no topic named '/cmd_vl' in domain 7 .did you mean '/cmd_vel'"):
        message_type(looker, "/cmd_vl")
    with pytest.raises(NotFoundError, match="no message type named 'Twits'"):
        message_type(looker, "/cmd_vel", "Twits")
    robot.create_publisher(Cart, "/cmd_vel", 10)
    with pytest.raises(SeveralTypesError, match="say which, carts/msg/Cart or geometry_msgs/msg/Twist"):
        message_type(looker, "/cmd_vel")
    with spinning(robot):
        for name in ("Cart", "carts/Cart", "carts/msg/Cart"):
            assert type_hash(message_type(looker, "/cmd_vel", name)) == type_hash(Cart)


def test_the_type_of_a_service(robot: Node, looker: Context) -> None:
    robot.create_service(Trigger, "/reset", lambda _, response: response)
    robot.create_client(Trigger, "/unserved")
    assert service_type(looker, "/reset") is Trigger
    assert service_type(looker, "/unserved", "Trigger") is Trigger
    with pytest.raises(NotFoundError, match="no service named '/unserved'"):
        service_type(looker, "/unserved")


def test_a_publisher_is_asked_rather_than_a_subscription(robot: Node, looker: Context) -> None:
    mute = Node("a_mute", context=robot.context, parameter_overrides=QUIET)
    mute.create_subscription(Cart, "/cart", lambda _: None, 10)
    robot.create_publisher(Cart, "/cart", 10)
    with spinning(robot):
        assert type_hash(message_type(looker, "/cart")) == type_hash(Cart)


# It is done when: echo shows a type that only the publishing process knows.


def test_echo_shows_a_type_that_only_the_publisher_knows(robot: Node, capsys: pytest.CaptureFixture[str]) -> None:
    publisher = robot.create_publisher(Cart, "/cart", LATCHED)
    publisher.publish(Cart(wheels=[Wheel(), Wheel(radius=0.2)], label="hay"))
    with spinning(robot):
        assert main(["topic", "echo", "--once", "/cart"]) == 0
    assert capsys.readouterr().out == "wheels:\n- radius: 0.1\n- radius: 0.2\nlabel: hay\n---\n"


def test_echo_says_in_a_line_why_it_cannot(robot: Node, capsys: pytest.CaptureFixture[str]) -> None:
    mute = made(robot.context, "mute")
    for service in list(mute.services):
        mute.destroy_service(service)
    mute.create_publisher(Cart, "/cart", 10)
    assert main(["topic", "echo", "--once", "/cart"]) == 1
    out, err = capsys.readouterr()
    assert (out, err.count("\n")) == ("", 1)
    assert err.startswith("robolink: /cart has the type carts/msg/Cart, which is not installed, and no node")


NODE_FILE = '''"""Publishes a type of its own."""

from robolink import Message, Node
from robolink.message import Sequence, float64, string


class Wheel(Message):
    radius: float64


class Cart(Message):
    wheels: Sequence[Wheel]
    label: string


class Carter(Node):
    def __init__(self) -> None:
        super().__init__("carter")
        publisher = self.create_publisher(Cart, "cart", 10)
        self.create_timer(0.05, lambda: publisher.publish(Cart(wheels=[Wheel(radius=0.5)], label="hay")))
        print("ready", flush=True)
'''


@pytest.mark.processes
def test_echo_shows_it_from_another_process_and_folder(
    domain: int, tmp_path: Path, tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = tmp_path / "carter.py"
    file.write_text(NODE_FILE)
    with Command(domain, "run", str(file)) as carter:
        carter.wait_for("ready")
        monkeypatch.chdir(tmp_path_factory.mktemp("elsewhere"))
        with Command(domain, "topic", "echo", "--once", "/cart", program=BUSY_ROBOLINK) as echo:
            assert echo.end() == 0
            assert [each.text for each in echo.lines] == ["wheels:", "- radius: 0.5", "label: hay", "---"]
        with Command(domain, "topic", "echo", "--once", "--json", "/cart", "Cart", program=BUSY_ROBOLINK) as echo:
            assert echo.end() == 0
            assert msgspec.json.decode(echo.lines[0].text) == {"wheels": [{"radius": 0.5}], "label": "hay"}


@pytest.mark.processes
def test_a_publisher_that_waits_says_what_its_type_is(
    domain: int, tmp_path: Path, tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch
) -> None:
    for part in ("nodes", "interfaces/carts_of_mine/msg"):
        (tmp_path / part).mkdir(parents=True)
    (tmp_path / "interfaces/carts_of_mine/msg/Cart.msg").write_text("string label\n")
    monkeypatch.chdir(tmp_path)
    with Command(domain, "topic", "pub", "--once", "/cart", "carts_of_mine/Cart", "{label: hay}") as pub:
        pub.wait_for("Waiting for at least 1")
        monkeypatch.chdir(tmp_path_factory.mktemp("elsewhere"))
        with Command(domain, "topic", "echo", "--once", "/cart", program=BUSY_ROBOLINK) as echo:
            assert echo.end() == 0
            assert [each.text for each in echo.lines] == ["label: hay", "---"]
        assert pub.end() == 0
