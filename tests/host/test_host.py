"""A host runs Node classes in virtual time: each a program with a session, a clock and an end of its own."""

from __future__ import annotations

import subprocess
import sys
from typing import Any

import pytest

from robolink import Duration, Node, Parameter, get_default_context, ok, shutdown
from robolink.callback_groups import ReentrantCallbackGroup
from robolink.exceptions import NotFoundError, ServiceError
from robolink.host import Host, HostError
from robolink.interfaces.example_interfaces.srv import AddTwoInts
from robolink.interfaces.std_msgs.msg import Int32
from robolink.launch.shared_process import Member
from robolink.running.timebase import SkewedTime
from robolink.task import Future
from robolink.transport.memory import MemoryTransport
from tests.support.hosts import Counter, Listener


@pytest.fixture
def ends(host: Host) -> list[tuple[str, str, int | None]]:
    told: list[tuple[str, str, int | None]] = []
    host.on_exit.append(lambda program: told.append((program.name, program.state, program.returncode)))
    return told


def test_programs_talk_and_time_jumps(host: Host) -> None:
    counter, listener = host.start_node(Counter), host.start_node(Listener)
    host.run(10.0)
    assert host.now == 10.0
    assert counter.count == 100
    assert listener.heard == list(range(1, 101))
    assert listener.times[0] == pytest.approx(1.1)


def test_each_program_has_a_session_and_a_context_of_its_own(host: Host) -> None:
    one, two = host.start_node(Counter, name="one"), host.start_node(Counter, name="two")
    assert one.context is not two.context
    assert one.context.transport.session_id != two.context.transport.session_id
    assert set(host.programs) == {"one", "two"}
    assert one.get_node_names() == ["one", "two"]


def test_classes_that_go_on_in_turn_switch_no_threads(host: Host) -> None:
    host.start_node(Counter)
    host.start_node(Listener)
    before = host.scheduler.switches
    host.run(100.0)
    assert host.scheduler.switches - before == 2


def test_a_node_gets_its_name_parameters_and_remappings(host: Host) -> None:
    class Named(Node):
        def __init__(self) -> None:
            super().__init__("named")
            self.words = self.declare_parameter("words", "none").value
            self.speeds = list(self.declare_parameter("speeds", [0.0]).value)
            self.out = self.create_publisher(Int32, "numbers", 10)

    node = host.start_node(
        Named,
        name="ada",
        namespace="lab",
        parameters={"words": "a b: [c", "speeds": [1.5, 2.0]},
        remappings={"numbers": "/counted"},
    )
    assert node.get_fully_qualified_name() == "/lab/ada"
    assert (node.words, node.speeds, node.out.topic_name) == ("a b: [c", [1.5, 2.0], "/counted")
    assert list(host.programs) == ["lab/ada"]


def test_run_until_stops_within_the_moment(host: Host) -> None:
    counter = host.start_node(Counter)
    assert host.run_until(lambda: counter.count >= 7, within=5.0)
    assert counter.count == 7
    assert host.now == pytest.approx(0.7)
    assert not host.run_until(lambda: counter.count >= 100, within=1.0)
    assert host.now == pytest.approx(1.7)


def test_what_a_condition_or_an_act_raises_comes_out_of_run(host: Host) -> None:
    host.start_node(Counter)
    with pytest.raises(ZeroDivisionError):
        host.run_until(lambda: 1 / 0 > 0, within=1.0)
    host.at(0.5, lambda: [].pop())
    with pytest.raises(IndexError):
        host.run(1.0)
    host.run(1.0)


def test_acts_come_before_the_callbacks_of_their_moment(host: Host) -> None:
    counter = host.start_node(Counter)
    seen: list[int] = []
    host.at(1.0, lambda: seen.append(counter.count))
    host.at(0.25, lambda: seen.append(-1))
    host.run(2.0)
    assert seen == [-1, 9]


def test_a_crash_is_silent_and_a_restart_a_new_life(host: Host, ends: list[Any]) -> None:
    listener = host.start_node(Listener)
    counter = host.start_node(Counter)
    session = counter.context.transport.session_id
    host.at(1.0, lambda: host.crash("Counter"))
    host.run(2.0)
    assert (len(listener.heard), listener.count_publishers("numbers")) == (9, 0)
    assert ends == [("Counter", "crashed", -9)]
    program = host.restart("Counter")
    host.run(1.0)
    assert listener.heard[9:] == list(range(1, 11))
    assert program.lives == 2
    assert program.context.transport.session_id != session
    assert program.nodes[0] is not counter


def test_stop_is_orderly(host: Host, ends: list[Any]) -> None:
    class Polite(Counter):
        def destroy_node(self) -> None:
            self.numbers.publish(Int32(data=-1))
            super().destroy_node()

    listener = host.start_node(Listener)
    host.start_node(Polite)
    host.run(0.35)
    host.stop("Polite")
    host.run(1.0)
    assert listener.heard == [1, 2, 3, -1]
    assert ends == [("Polite", "ended", 0)]


def test_an_exception_ends_its_program_alone(host: Host, ends: list[Any]) -> None:
    class Breaks(Counter):
        def tick(self) -> None:
            super().tick()
            if self.count == 3:
                raise ValueError("three")

    listener = host.start_node(Listener)
    host.start_node(Breaks)
    other = host.start_node(Counter, remappings={"numbers": "others"})
    host.run(1.0)
    assert ends == [("Breaks", "crashed", 1)]
    assert isinstance(host.programs["Breaks"].error, ValueError)
    assert (listener.heard, other.count) == ([1, 2, 3], 10)
    assert listener.count_publishers("numbers") == 0


def test_a_program_without_opencv_ends_with_what_to_install(
    host: Host, ends: list[Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    class Sees(Counter):
        def tick(self) -> None:
            import cv2  # noqa: F401

    host.start_node(Sees)
    monkeypatch.setitem(sys.modules, "cv2", None)
    host.run(1.0)
    assert ends == [("Sees", "crashed", 1)]
    words = "test_host.py needs OpenCV, which is not installed: pip install opencv-python"
    assert str(host.programs["Sees"].error) == words


@pytest.mark.parametrize(("code", "returncode"), [(3, 3), (None, 0), ("words", 1)])
def test_sys_exit_in_a_callback_ends_its_program_alone(host: Host, ends: list[Any], code: Any, returncode: int) -> None:
    class Leaves(Counter):
        def tick(self) -> None:
            raise SystemExit(code)

    host.start_node(Leaves)
    other = host.start_node(Counter)
    host.run(1.0)
    assert ends == [("Leaves", "ended", returncode)]
    assert other.count == 10


def test_shutdown_ok_and_the_default_context_are_a_programs_own(host: Host, ends: list[Any]) -> None:
    class Ends(Counter):
        def tick(self) -> None:
            super().tick()
            self.was_ok = ok()
            assert get_default_context() is self.context
            if self.count == 2:
                shutdown()
                self.is_ok = ok()

    node = host.start_node(Ends)
    other = host.start_node(Counter)
    host.run(1.0)
    assert (node.was_ok, node.is_ok, node.count, other.count) == (True, False, 2, 10)
    assert ends == [("Ends", "ended", 0)]
    assert get_default_context() is not node.context


def test_what_a_class_raises_while_it_is_made_reaches_the_caller(host: Host) -> None:
    class Fails(Node):
        def __init__(self) -> None:
            super().__init__("fails")
            raise KeyError("no")

    with pytest.raises(KeyError):
        host.start_node(Fails)
    assert host.programs == {}


def test_a_callback_that_calls_a_service_lets_all_others_go_on(host: Host) -> None:
    class Slow(Node):
        def __init__(self) -> None:
            super().__init__("slow")
            self.create_service(AddTwoInts, "add", self.add)

        def add(self, request: Any, response: Any) -> Any:
            self.get_clock().sleep_for(Duration(seconds=0.55))
            response.sum = request.a + request.b
            return response

    class Asks(Counter):
        def __init__(self) -> None:
            super().__init__()
            self.sums: list[tuple[int, float, int]] = []
            self.client = self.create_client(AddTwoInts, "add")
            self.create_timer(1.0, self.ask)

        def ask(self) -> None:
            answer = self.client.call(AddTwoInts.Request(a=1, b=2), timeout_sec=5.0)
            self.sums.append((answer.sum, self.get_clock().now().nanoseconds / 1e9, self.count))

    host.start_node(Slow)
    asks, listener = host.start_node(Asks), host.start_node(Listener)
    other = host.start_node(Counter, remappings={"numbers": "others"})
    host.run(1.75)
    assert asks.sums == [(3, pytest.approx(2.55), 10)]  # its own other timer waits, as in a process
    assert other.count == 17
    assert listener.heard == list(range(1, 14))


def test_a_group_is_kept_busy_by_a_coroutine_until_it_ends(host: Host) -> None:
    class Awaits(Node):
        def __init__(self) -> None:
            super().__init__("awaits")
            self.begun: list[str] = []
            self.opened: Future[None] = Future()
            self.create_timer(0.05, self.wait)
            self.create_timer(0.2, lambda: self.begun.append("after it"))
            self.create_timer(0.45, self.open, callback_group=ReentrantCallbackGroup())
            self.create_subscription(Int32, "numbers", lambda message: self.begun.append("number"), 10)

        async def wait(self) -> None:
            self.begun.append("waits")
            await self.opened
            self.begun.append("goes on")

        def open(self) -> None:
            self.begun.append("opens")
            self.opened.set_result(None)

    host.start_node(Counter)
    awaits = host.start_node(Awaits)
    host.run(0.465)
    assert awaits.begun[:3] == ["waits", "opens", "goes on"]
    assert {"after it", "number"} <= set(awaits.begun[3:])


def test_an_exception_in_a_coroutine_ends_its_program(host: Host, ends: list[Any]) -> None:
    class Breaks(Node):
        def __init__(self) -> None:
            super().__init__("breaks")
            self.create_timer(0.1, self.fail)

        async def fail(self) -> None:
            raise ValueError("no more")

    host.start_node(Breaks)
    host.run(1.0)
    assert ends == [("Breaks", "crashed", 1)]


def test_code_outside_may_call_and_wait_as_well(host: Host) -> None:
    class Adds(Node):
        def __init__(self) -> None:
            super().__init__("adds")
            self.create_service(AddTwoInts, "add", self.add)

        def add(self, request: Any, response: Any) -> Any:
            response.sum = request.a + request.b
            return response

    probe = host.start_node(Listener)
    client = probe.create_client(AddTwoInts, "add")
    assert not client.wait_for_service(timeout_sec=2.0)
    assert host.now == pytest.approx(2.0)
    with pytest.raises(ServiceError):
        client.call(AddTwoInts.Request())
    host.at(3.0, lambda: host.restart("Adds"))
    host.start_node(Adds)
    host.crash("Adds")
    assert client.wait_for_service()
    assert host.now == pytest.approx(3.0)
    assert client.call(AddTwoInts.Request(a=2, b=3)).sum == 5


def test_a_program_keeps_its_own_time() -> None:
    with Host(clock=lambda name, time: SkewedTime(time, ahead=10**9, drift=0.1) if name == "fast" else time) as skewed:
        fast = skewed.start_node(Counter, called="fast")
        exact = skewed.start_node(Counter, called="exact")
        skewed.run(10.0)
        assert (fast.count, exact.count) == (110, 100)
        assert fast.get_clock().now().nanoseconds == 13 * 10**9


def test_each_program_gets_the_session_that_connect_gives() -> None:
    asked: list[str] = []

    def connect(name: str) -> MemoryTransport:
        asked.append(name)
        return MemoryTransport(bus=made.bus)

    with Host(connect=connect) as made:
        made.start_node(Counter, called="a")
        made.start_node(Listener, called="b")
        made.restart("a")
    assert asked == ["a", "b", "a"]


def test_several_nodes_share_a_program(host: Host) -> None:
    members = [
        Member("follower", "wall_follower", ["--ros-args", "-r", "__node:=follower", "-p", "speed:=0.1"]),
        Member("second", "wall_follower", ["--ros-args", "-r", "__node:=two"]),
    ]
    program = host.start("both", members)
    host.run(0.1)
    assert [each.get_name() for each in program.nodes] == ["follower", "two"]
    assert program.nodes[0].get_parameter("speed").value == 0.1
    assert program.nodes[1].get_parameter("speed").value != 0.1
    assert len(program.contexts) == 1


def test_names_that_are_not_there_or_taken(host: Host) -> None:
    host.start_node(Counter, called="counter")
    with pytest.raises(HostError, match="counter runs already"):
        host.start("counter", [Member("counter", "wall_follower", [])])
    with pytest.raises(NotFoundError, match="did you mean 'counter'"):
        host.stop("countr")
    with pytest.raises(NotFoundError):
        host.start("x", [Member("x", "no_such_node", [])])


def test_parameters_are_set_as_in_a_process(host: Host) -> None:
    counter = host.start_node(Counter)
    counter.declare_parameter("limit", 3)
    counter.set_parameters([Parameter("limit", value=5)])
    assert counter.get_parameter("limit").value == 5


def test_ctrl_c_while_the_turn_is_handed_on(host: Host, monkeypatch: pytest.MonkeyPatch) -> None:
    counter, turns = host.start_node(Counter), host.scheduler
    hand_to = turns._hand_to

    def interrupted(turn: Any) -> None:
        monkeypatch.undo()
        hand_to(turn)
        raise KeyboardInterrupt

    monkeypatch.setattr(turns, "_hand_to", interrupted)
    with pytest.raises(KeyboardInterrupt):
        host.run(1.0)
    assert turns.holder is turns.outside
    host.run(1.0)
    assert counter.count >= 10


@pytest.mark.processes
def test_a_process_that_a_node_starts_is_noted(host: Host) -> None:
    class Starter(Node):
        def __init__(self) -> None:
            super().__init__("starter")
            subprocess.run([sys.executable, "-c", ""], check=True)

    host.start_node(Starter)
    (use,) = (each for each in host.real_time_use if each.what == "subprocess.Popen")
    assert use.program == "Starter"
    assert use.place.startswith(f"{__file__}:")
