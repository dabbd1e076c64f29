"""Managed nodes: every way through their states, what their callbacks may do, their services, topic and publishers."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink import Context, Node
from robolink.exceptions import InterruptedByUser
from robolink.executors import SingleThreadedExecutor
from robolink.impl.log_output import Record
from robolink.interfaces.lifecycle_msgs.msg import State, Transition, TransitionEvent
from robolink.interfaces.lifecycle_msgs.srv import (
    ChangeState,
    GetAvailableStates,
    GetAvailableTransitions,
    GetState,
)
from robolink.interfaces.std_msgs.msg import Int32
from robolink.lifecycle import (
    LifecycleNode,
    LifecycleNodeMixin,
    LifecycleState,
    ManagedEntity,
    SimpleManagedEntity,
    TransitionCallbackReturn,
)
from robolink.lifecycle.state_machine import STATES, STEPS, LifecycleStateMachine, Step, TransitionError
from tests.support.spins import done, numbers, spin_for

SUCCESS, FAILURE, ERROR = TransitionCallbackReturn


def state_of(node: LifecycleNode) -> str:
    return node._state_machine.current_state[1]


class Told(ManagedEntity):
    """Writes down what it is told, and answers as it is asked to."""

    def __init__(self, name: str, told: list[Any], **answers: Any) -> None:
        self.name, self.told, self.answers = name, told, answers

    def __getattribute__(self, name: str) -> Any:
        if not name.startswith("on_"):
            return super().__getattribute__(name)
        return functools.partial(self.tell, name)

    def tell(self, callback: str, state: LifecycleState) -> Any:
        self.told.append((self.name, callback, state.label))
        answer = self.answers.get(callback, SUCCESS)
        if isinstance(answer, BaseException):
            raise answer
        return answer


@pytest.fixture
def node(virtual: Context, executor: SingleThreadedExecutor) -> LifecycleNode:
    made = LifecycleNode("camera", context=virtual)
    executor.add_node(made)
    return made


# --- the state machine ----------------------------------------------------------------------------------------


def test_the_steps_are_those_of_the_design() -> None:
    assert {step.label for step in STEPS if step.id < 10} == {
        "configure",
        "cleanup",
        "activate",
        "deactivate",
        "shutdown",
    }
    # What `ros2 lifecycle list -a` prints first, and last.
    assert [tuple(step)[:2] + step[3::2] for step in (*STEPS[:4], STEPS[-1])] == [
        (1, "configure", "unconfigured", "configuring"),
        (10, "transition_success", "configuring", "inactive"),
        (11, "transition_failure", "configuring", "unconfigured"),
        (12, "transition_error", "configuring", "errorprocessing"),
        (62, "transition_error", "errorprocessing", "finalized"),
    ]
    constants = {name: value for name, value in vars(Transition).items() if name.startswith("TRANSITION_")}
    named = {value for name, value in constants.items() if "CALLBACK" not in name} - {0, 8}  # create and destroy
    assert {step.id for step in STEPS} == named
    assert {step.id for step in STEPS if step.label == "shutdown"} == {5, 6, 7}


@given(st.lists(st.sampled_from([*sorted({step.label for step in STEPS}), "", "fly"])))
def test_the_machine_is_always_in_a_state_that_a_step_led_to(labels: list[str]) -> None:
    machine = LifecycleStateMachine()
    steps: list[Step] = []
    machine.on_step = steps.append
    for label in labels:
        before = machine.current_state
        possible = {step.label: step for step in machine.available_transitions}
        if label in possible:
            machine.trigger_transition_by_label(label)
            assert machine.current_state == (possible[label].goal_id, possible[label].goal_label)
            assert steps[-1] == possible[label]
        else:
            with pytest.raises(TransitionError, match=f"no transition '{label}' from {before[1]}"):
                machine.trigger_transition_by_label(label)
            assert machine.current_state == before
    assert machine.current_state in machine.available_states


def test_a_finalized_machine_goes_nowhere() -> None:
    machine = LifecycleStateMachine()
    machine.trigger_transition_by_id(Transition.TRANSITION_UNCONFIGURED_SHUTDOWN)
    machine.trigger_transition_by_label("transition_success")
    assert (machine.current_state, machine.available_transitions) == ((4, "finalized"), [])
    with pytest.raises(TransitionError, match="no transition 'configure' from finalized: there is none"):
        machine.get_transition_by_label("configure")


# --- callbacks ------------------------------------------------------------------------------------------------

TRIGGERS = ["configure", "cleanup", "activate", "deactivate", "shutdown"]
BEFORE = {"configure": [], "cleanup": ["configure"], "activate": ["configure"]}
BEFORE |= {"deactivate": ["configure", "activate"], "shutdown": ["configure", "activate"]}
STARTS = {"configure": "unconfigured", "cleanup": "inactive", "activate": "inactive"}
STARTS |= {"deactivate": "active", "shutdown": "active"}
GOALS = {"configure": "inactive", "cleanup": "unconfigured", "activate": "active"}
GOALS |= {"deactivate": "inactive", "shutdown": "finalized"}


def trigger(node: LifecycleNode, what: str) -> TransitionCallbackReturn:
    made: TransitionCallbackReturn = getattr(node, f"trigger_{what}")()
    return made


def prepared(node: LifecycleNode, what: str, **answers: Any) -> list[Any]:
    """Bring it where `what` begins; what is then told to an entity."""
    for each in BEFORE[what]:
        assert trigger(node, each) is SUCCESS
    told: list[Any] = []
    node.add_managed_entity(Told("entity", told, **answers))
    return told


@pytest.mark.parametrize("what", TRIGGERS)
def test_each_transition_runs_its_callback_with_the_state_before(node: LifecycleNode, what: str) -> None:
    told = prepared(node, what)
    assert trigger(node, what) is SUCCESS
    assert (told, state_of(node)) == ([("entity", f"on_{what}", STARTS[what])], GOALS[what])


@pytest.mark.parametrize("what", TRIGGERS)
def test_a_failure_leads_back(node: LifecycleNode, what: str) -> None:
    prepared(node, what, **{f"on_{what}": FAILURE})
    assert trigger(node, what) is FAILURE
    assert state_of(node) == ("finalized" if what == "shutdown" else STARTS[what])


@pytest.mark.parametrize("what", TRIGGERS)
@pytest.mark.parametrize("answer", [ERROR, ValueError("no lens"), None, True, "SUCCESS"])
@pytest.mark.parametrize(("after", "goal"), [(SUCCESS, "unconfigured"), (FAILURE, "finalized"), (ERROR, "finalized")])
def test_an_error_goes_to_on_error(
    node: LifecycleNode, log_lines: list[Record], what: str, answer: Any, after: Any, goal: str
) -> None:
    told = prepared(node, what, **{f"on_{what}": answer, "on_error": after})
    assert trigger(node, what) is ERROR
    assert told == [("entity", f"on_{what}", STARTS[what]), ("entity", "on_error", STARTS[what])]
    assert state_of(node) == goal
    logged = [each.message for each in log_lines if each.name == "camera"]
    assert len(logged) == (0 if answer is ERROR else 1)
    if isinstance(answer, ValueError):
        assert logged[0].startswith(f"on_{what} failed:\nTraceback")
        assert logged[0].endswith("ValueError: no lens")
    elif answer is not ERROR:
        assert f"Told.on_{what} must return a TransitionCallbackReturn, got {answer!r}" in logged[0]


def test_an_on_error_that_raises_ends_the_node(node: LifecycleNode, log_lines: list[Record]) -> None:
    prepared(node, "configure", on_configure=ERROR, on_error=KeyError("twice"))
    assert (node.trigger_configure(), state_of(node)) == (ERROR, "finalized")
    assert "KeyError: 'twice'" in log_lines[-1].message


def test_ctrl_c_in_a_callback_is_no_error_of_it(node: LifecycleNode) -> None:
    prepared(node, "configure", on_configure=InterruptedByUser())
    with pytest.raises(KeyboardInterrupt):
        node.trigger_configure()


def test_entities_are_told_in_their_order_until_one_does_not_succeed(node: LifecycleNode) -> None:
    told: list[Any] = []
    for name, answer in (("a", SUCCESS), ("b", FAILURE), ("c", SUCCESS)):
        node.add_managed_entity(Told(name, told, on_configure=answer))
    assert node.trigger_configure() is FAILURE
    assert [name for name, *_ in told] == ["a", "b"]
    with pytest.raises(TypeError, match="expected a ManagedEntity, got 'x'"):
        node.add_managed_entity("x")  # type: ignore[arg-type]


def test_a_transition_that_is_not_there_is_an_error_and_a_line(node: LifecycleNode, log_lines: list[Record]) -> None:
    assert (node.trigger_activate(), state_of(node)) == (ERROR, "unconfigured")
    assert [each.message for each in log_lines] == [
        "no transition '3' from unconfigured: there is configure [1], shutdown [5]"
    ]
    assert node.trigger_shutdown() is SUCCESS
    with pytest.raises(RuntimeError, match="no shutdown from finalized"):
        node.trigger_shutdown()


def test_a_callback_cannot_make_another_transition(virtual: Context, log_lines: list[Record]) -> None:
    class Hasty(LifecycleNode):
        def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
            assert self._change_state_(Transition.TRANSITION_ON_CONFIGURE_ERROR) is ERROR
            assert self.trigger_activate() is ERROR
            return super().on_configure(state)

    node = Hasty("hasty", context=virtual)
    assert (node.trigger_configure(), state_of(node)) == (SUCCESS, "inactive")
    assert log_lines[0].message == "no transition '12' while on_configure runs"


def test_a_simple_entity_knows_whether_it_is_active(node: LifecycleNode) -> None:
    calls: list[Any] = []

    class Lamp(SimpleManagedEntity):
        @SimpleManagedEntity.when_enabled
        def shine(self, colour: str) -> None:
            calls.append(colour)

        @SimpleManagedEntity.when_enabled(when_not_enabled=lambda: calls.append("dark"))
        def blink(self) -> None:
            calls.append("blink")

    lamp = Lamp()
    node.add_managed_entity(lamp)
    node.trigger_configure()
    for active in (False, True, False):
        assert lamp.is_activated is active
        lamp.shine("red")
        lamp.blink()
        trigger(node, "deactivate" if active else "activate")
    assert calls == ["dark", "red", "blink", "dark"]
    assert Lamp.shine.__name__ == "shine"


# --- publishers -----------------------------------------------------------------------------------------------


def test_a_publisher_sends_only_while_active(
    node: LifecycleNode, executor: SingleThreadedExecutor, log_lines: list[Record]
) -> None:
    got = numbers(node, "count")
    publisher = node.create_lifecycle_publisher(Int32, "count", 10)
    for number, what in enumerate(["configure", "activate", "deactivate", "cleanup"]):
        publisher.publish(Int32(data=number))
        publisher.publish(Int32(data=number))
        assert trigger(node, what) is SUCCESS
    spin_for(executor, 0.1)
    assert got == [2, 2]
    told = "dropped a message for /count: its publisher is not active (the next ones go silently)"
    assert [each.message for each in log_lines] == [told, told]  # once before, and once after it was active


def test_a_publisher_that_is_destroyed_is_told_no_more(node: LifecycleNode) -> None:
    publisher = node.create_lifecycle_publisher(Int32, "count", 10)
    assert node.destroy_lifecycle_publisher(publisher) is True
    assert node.destroy_lifecycle_publisher(publisher) is False
    node.trigger_configure()
    node.trigger_activate()
    assert publisher.is_activated is False
    with pytest.raises(TypeError, match="publisher_class"):
        node.create_lifecycle_publisher(Int32, "count", 10, publisher_class=int)  # type: ignore[arg-type]


def test_a_subclass_may_make_all_its_publishers_managed(virtual: Context) -> None:
    class AllManaged(LifecycleNode):
        def create_publisher(self, msg_type: Any, topic: str, qos_profile: Any, **kwargs: Any) -> Any:
            if hasattr(self, "_state_machine"):
                return self.create_lifecycle_publisher(msg_type, topic, qos_profile, **kwargs)
            return super().create_publisher(msg_type, topic, qos_profile, **kwargs)

    node = AllManaged("managed", context=virtual)
    assert hasattr(node.create_publisher(Int32, "count", 10), "is_activated")
    assert node.trigger_configure() is SUCCESS


# --- the services and the topic -------------------------------------------------------------------------------


def asked(node: Node, executor: SingleThreadedExecutor, srv_type: Any, name: str, **fields: Any) -> Any:
    client = node.create_client(srv_type, f"/camera/{name}")
    return done(executor, client.call_async(srv_type.Request(**fields)))


Ask = Callable[..., Any]


@pytest.fixture
def ask(node: LifecycleNode, virtual: Context, executor: SingleThreadedExecutor) -> Ask:
    asker = Node("asker", context=virtual)
    executor.add_node(asker)
    return functools.partial(asked, asker, executor)


def test_others_see_and_drive_it(node: LifecycleNode, ask: Ask) -> None:
    assert ask(GetState, "get_state").current_state == State(id=1, label="unconfigured")
    states = ask(GetAvailableStates, "get_available_states").available_states
    assert {each.id: each.label for each in states} == STATES
    graph = ask(GetAvailableTransitions, "get_transition_graph").available_transitions
    assert [(each.transition.id, each.start_state.label, each.goal_state.id) for each in graph] == [
        (step.id, step.start_label, step.goal_id) for step in STEPS
    ]
    assert ask(ChangeState, "change_state", transition=Transition(id=1)).success is True
    there = ask(GetAvailableTransitions, "get_available_transitions").available_transitions
    assert [(each.transition.label, each.transition.id) for each in there] == [
        ("cleanup", 2),
        ("activate", 3),
        ("shutdown", 6),
    ]
    # A label wins over the number, and means the shutdown of the state that it is in.
    assert ask(ChangeState, "change_state", transition=Transition(id=3, label="shutdown")).success is True
    assert state_of(node) == "finalized"


@pytest.mark.parametrize("wanted", [Transition(id=3), Transition(label="fly"), Transition(id=10), Transition(id=255)])
def test_what_cannot_be_is_refused(node: LifecycleNode, ask: Ask, wanted: Transition) -> None:
    assert ask(ChangeState, "change_state", transition=wanted).success is False
    assert state_of(node) == "unconfigured"


def test_a_callback_that_fails_is_told_to_who_asked(node: LifecycleNode, ask: Ask) -> None:
    prepared(node, "configure", on_configure=FAILURE)
    assert ask(ChangeState, "change_state", transition=Transition(id=1)).success is False
    assert ask(GetState, "get_state").current_state.label == "unconfigured"


def test_each_step_is_told_on_the_topic(virtual: Context, executor: SingleThreadedExecutor) -> None:
    node = LifecycleNode("camera", context=virtual, namespace="/lab")
    events: list[TransitionEvent] = []
    listener = Node("listener", context=virtual)
    listener.create_subscription(TransitionEvent, "/lab/camera/transition_event", events.append, 10)
    executor.add_node(listener)
    spin_for(executor, 2.0)
    node.trigger_configure()
    spin_for(executor, 0.1)
    assert [(each.transition.label, each.start_state.label, each.goal_state.label) for each in events] == [
        ("configure", "unconfigured", "configuring"),
        ("transition_success", "configuring", "inactive"),
    ]
    assert {each.timestamp for each in events} == {2_000_000_000}


def test_a_node_may_keep_to_itself(virtual: Context) -> None:
    node = LifecycleNode("quiet", context=virtual, enable_communication_interface=False)
    other = LifecycleNode("loud", context=virtual)
    names = {name for name, _ in other.get_service_names_and_types()}
    assert not {"/quiet/change_state", "/quiet/get_state", "/quiet/get_available_states"} & names
    assert {"/loud/change_state", "/loud/get_transition_graph"} <= names
    assert node.trigger_configure() is SUCCESS
    assert node._state_machine.service_get_state is None
    assert other._state_machine.service_get_state is not None


def test_a_node_that_cannot_be_made_leaves_nothing_behind(virtual: Context) -> None:
    with pytest.raises(TypeError, match="enable_communication_interface: expected a bool, got 'asd'"):
        LifecycleNode("odd", context=virtual, enable_communication_interface="asd")  # type: ignore[arg-type]
    assert "odd" not in Node("other", context=virtual).get_node_names()
    with pytest.raises(RuntimeError, match="needs Node beside it"):
        LifecycleNodeMixin()


def test_a_destroyed_node_can_still_be_ended_in_good_order(node: LifecycleNode) -> None:
    node.destroy_node()
    assert node.trigger_shutdown() is SUCCESS
    assert "camera" not in Node("other", context=node.context).get_node_names()
