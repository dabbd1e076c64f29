"""rclpy's small modules: type_support, serialization, init and shutdown, utilities, and the C library's name."""

from __future__ import annotations

import contextlib
import importlib
import os
import signal
import sys
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

import robolink
from robolink import Context, SignalHandlerOptions
from robolink.clock import ROSClock
from robolink.exceptions import DecodeError, EncodeError, NotInitializedException, NoTypeSupportImportedException
from robolink.impl.implementation_singleton import HOMES, rclpy_implementation
from robolink.interfaces.example_interfaces.action import Fibonacci
from robolink.interfaces.std_srvs.srv import SetBool
from robolink.serialization import deserialize_message, serialize_message
from robolink.signals import get_current_signal_handlers_options
from robolink.transport.memory import MemoryTransport
from robolink.type_support import check_for_type_support, check_is_valid_msg_type, check_is_valid_srv_type
from robolink.utilities import get_available_rmw_implementations
from tests.support.ros_test_types import filled_messages
from tests.support.ros_test_types import msg as ros

# --- names at second hand ---------------------------------------------------------------------------------------

SECOND_HAND = {
    "executors": "ExternalShutdownException Future Task get_default_context",
    "node": "CallbackGroup Client Clock Context GuardCondition MsgT MutuallyExclusiveCallbackGroup "
    "NotInitializedException Parameter Publisher PublisherEventCallbacks QoSProfile ROSClock Rate RcutilsLogger "
    "ReentrantCallbackGroup Service Subscription SubscriptionEventCallbacks Timer TypeDescriptionService "
    "get_default_context get_logger qos_profile_services_default",
}
"""Names that programs import from modules of rclpy's which import them from others (`from rclpy.node import Timer`)."""


@pytest.mark.parametrize(("module", "name"), [(m, n) for m, names in SECOND_HAND.items() for n in names.split()])
def test_a_name_at_second_hand(module: str, name: str) -> None:
    """It was there by chance, since the module used it; a move of code must not take it from the user's program."""
    found = getattr(importlib.import_module(f"robolink.{module}"), name)
    assert getattr(found, "__name__", name) == name


# --- types ----------------------------------------------------------------------------------------------------


def test_what_is_a_type() -> None:
    for each in (ros.Strings, SetBool, Fibonacci, SetBool.Request, Fibonacci.Goal):
        check_for_type_support(each)
    check_is_valid_msg_type(SetBool.Response)
    check_is_valid_srv_type(SetBool)


@pytest.mark.parametrize("wrong", [object(), int, ros.Strings(), None, "std_msgs/msg/String"])
def test_what_is_no_type(wrong: Any) -> None:
    with pytest.raises(AttributeError, match="is not the class of a message, service or action"):
        check_for_type_support(wrong)


@pytest.mark.parametrize(
    ("check", "wrong"),
    [
        (check_is_valid_msg_type, SetBool),
        (check_is_valid_msg_type, Fibonacci),
        (check_is_valid_srv_type, ros.Strings),
        (check_is_valid_srv_type, Fibonacci),
    ],
)
def test_a_type_of_another_kind(check: Any, wrong: type[Any]) -> None:
    with pytest.raises(RuntimeError, match=r"is not a (message|service) class, but one of"):
        check(wrong)


class Compiled(type):
    """What rosidl gives its classes."""

    _TYPE_SUPPORT: Any = None
    loads = True

    def __import_type_support__(cls) -> None:
        cls._TYPE_SUPPORT = object() if cls.loads else None


def test_a_class_that_rosidl_made_is_one_once_its_compiled_part_is_loaded() -> None:
    check_for_type_support(Compiled("Loads", (), {}))
    with pytest.raises(NoTypeSupportImportedException, match="cannot be loaded"):
        check_for_type_support(Compiled("Lost", (), {"loads": False}))
    with pytest.raises(RuntimeError):
        check_is_valid_msg_type(Compiled("Foreign", (), {}))


# --- bytes ----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", sorted(vars(ros)))
def test_every_message_of_test_msgs_comes_back(name: str) -> None:
    messages = filled_messages(getattr(ros, name))
    assert len(messages) == 4
    for message in messages:
        assert deserialize_message(serialize_message(message), type(message)) == message


def test_filled_messages_differ() -> None:
    new, low, middle, high = (each.int8_value for each in filled_messages(ros.BasicTypes))  # type: ignore[attr-defined]
    assert (new, low, middle, high) == (0, -128, 0, 127)
    assert [len(each.string_values) for each in filled_messages(ros.BoundedSequences)] == [0, 0, 2, 3]  # type: ignore[attr-defined]


def test_what_cannot_be_bytes() -> None:
    with pytest.raises(EncodeError, match=r"BasicTypes\.int8_value"):
        serialize_message(ros.BasicTypes(int8_value=1000))
    with pytest.raises(AttributeError, match="is not the class of a message"):
        serialize_message("text")  # type: ignore[arg-type]
    with pytest.raises(RuntimeError, match="is not a message class"):
        deserialize_message(b"", SetBool)  # type: ignore[type-var]


@given(st.binary(max_size=64))
def test_bytes_are_a_message_or_a_decode_error(data: bytes) -> None:
    with contextlib.suppress(DecodeError):
        assert isinstance(deserialize_message(data, ros.Strings), ros.Strings)


# --- the C library's name -------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", sorted(HOMES))
def test_what_stands_for_a_name_of_the_c_library(name: str) -> None:
    assert getattr(rclpy_implementation, name) is not None
    assert name in dir(rclpy_implementation)


def test_bytes_by_the_c_librarys_names() -> None:
    data = rclpy_implementation.rclpy_serialize(ros.Strings(string_value="hi"), ros.Strings)
    assert rclpy_implementation.rclpy_deserialize(data, ros.Strings).string_value == "hi"
    with pytest.raises(TypeError, match="expected a"):
        rclpy_implementation.rclpy_serialize(ros.BasicTypes(), ros.Strings)


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("WaitSet", "nothing that stands for its 'WaitSet'; a Node and an Executor do what it is for"),
        ("rclpy_serialise", "nothing that stands for its 'rclpy_serialise'"),
        ("RCLErr", "nothing that stands for its 'RCLErr' (did you mean 'RCLError'?)"),
    ],
)
def test_a_name_of_the_c_library_that_nothing_stands_for(name: str, said: str) -> None:
    with pytest.raises(AttributeError) as caught:
        getattr(rclpy_implementation, name)
    assert said in str(caught.value)


# --- init -----------------------------------------------------------------------------------------------------


@pytest.fixture
def _in_memory(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROBOLINK_TRANSPORT", "memory://")
    monkeypatch.delenv("ROS_DOMAIN_ID", raising=False)


@pytest.mark.usefixtures("_in_memory")
def test_init_lasts_as_long_as_its_block() -> None:
    before = signal.getsignal(signal.SIGINT)
    with robolink.init(args=["--ros-args", "-r", "__node:=other"], domain_id=9) as initialized:
        assert initialized.context is robolink.get_default_context()
        assert (robolink.ok(), initialized.context.get_domain_id()) == (True, 9)
        assert robolink.create_node("node").get_name() == "other"
        assert get_current_signal_handlers_options() == SignalHandlerOptions.ALL
    assert (robolink.ok(), signal.getsignal(signal.SIGINT)) == (False, before)
    robolink.init(args=[])  # there is a new default context
    with pytest.raises(RuntimeError):
        robolink.init(args=[])


@pytest.mark.parametrize(
    ("given", "handled"),
    [
        (None, SignalHandlerOptions.NO),
        (SignalHandlerOptions.SIGINT, SignalHandlerOptions.SIGINT),
        (SignalHandlerOptions.SIGTERM, SignalHandlerOptions.SIGTERM),
        (SignalHandlerOptions.ALL, SignalHandlerOptions.ALL),
        (SignalHandlerOptions.NO, SignalHandlerOptions.NO),
    ],
)
def test_a_context_of_ones_own_handles_no_signals_unless_asked(given: Any, handled: SignalHandlerOptions) -> None:
    context = Context(transport=MemoryTransport())
    with robolink.init(args=[], context=context, signal_handler_options=given):
        assert get_current_signal_handlers_options() == handled
    assert get_current_signal_handlers_options() == SignalHandlerOptions.NO
    assert context.ok() is False


@pytest.mark.usefixtures("_in_memory")
@pytest.mark.parametrize(
    ("uninstall", "is_default", "left"),
    [(None, True, False), (True, True, False), (False, True, True), (None, False, True), (True, False, False)],
)
def test_shutdown_gives_the_signals_back_where_it_should(uninstall: bool | None, is_default: bool, left: bool) -> None:
    context = None if is_default else Context(transport=MemoryTransport())
    robolink.init(args=[], context=context, signal_handler_options=SignalHandlerOptions.ALL)
    robolink.shutdown(context=context, uninstall_handlers=uninstall)
    assert (get_current_signal_handlers_options() == SignalHandlerOptions.ALL) is left


@pytest.mark.usefixtures("_in_memory")
def test_the_default_context_may_also_be_named() -> None:
    context = robolink.get_default_context()
    robolink.init(args=[], context=context)
    assert get_current_signal_handlers_options() == SignalHandlerOptions.ALL
    robolink.shutdown(context=context)
    assert get_current_signal_handlers_options() == SignalHandlerOptions.NO


def test_who_comes_after_the_end_is_told_of_it_at_once() -> None:
    told: list[str] = []
    context = Context(transport=MemoryTransport())
    context.on_shutdown(lambda: told.append("before init"))
    context.init([])
    context.on_shutdown(lambda: told.append("before the end"))
    context.shutdown()
    context.on_shutdown(lambda: told.append("after"))
    assert told == ["before init", "before the end", "after"]
    with pytest.raises(TypeError, match="callback should be a callable, got <class 'int'>"):
        context.on_shutdown(1)  # type: ignore[arg-type]


@pytest.mark.usefixtures("known_as_robolink")
def test_an_exception_may_say_more() -> None:
    assert str(NotInitializedException()) == "robolink.init() has not been called"
    assert str(NotInitializedException("cannot create node")).endswith("called: cannot create node")


def test_errors_name_what_the_program_imports(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "rclpy", robolink)
    assert str(NotInitializedException()) == "rclpy.init() has not been called"
    with pytest.raises(TypeError, match=r"^the time must be a rclpy\.time\.Time, got 3$"):
        ROSClock().set_ros_time_override(3)  # type: ignore[arg-type]
    monkeypatch.delitem(sys.modules, "robolink.qos_event", raising=False)
    with pytest.warns(UserWarning, match=r"^rclpy\.qos_event is the older name of rclpy\.event_handler"):
        importlib.import_module("robolink.qos_event")


# --- utilities ------------------------------------------------------------------------------------------------


def test_the_middlewares_can_be_limited_to_those_there_are(monkeypatch: pytest.MonkeyPatch) -> None:
    own = robolink.get_rmw_implementation_identifier()
    assert get_available_rmw_implementations() == {own}
    monkeypatch.setenv("RMW_IMPLEMENTATIONS", own)
    assert get_available_rmw_implementations() == {own}
    monkeypatch.setenv("RMW_IMPLEMENTATIONS", os.pathsep.join([own, "rmw_other_cpp"]))
    with pytest.raises(RuntimeError, match=f"RMW_IMPLEMENTATIONS: there is no rmw_other_cpp, only {own}"):
        get_available_rmw_implementations()
