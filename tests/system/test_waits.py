"""Every public call that blocks waits in pieces of 0.25 s at most, between which Windows notices Ctrl-C."""

from __future__ import annotations

import contextlib
import queue
import threading
import time
from collections.abc import Callable
from concurrent.futures import Future as ThreadFuture
from concurrent.futures import TimeoutError as NotInTime
from pathlib import Path
from typing import Any

import pytest

import robolink as rclpy
from robolink import Context, Node
from robolink.action import ActionClient, ActionServer
from robolink.bag.playing.player import Player
from robolink.cli.main import main
from robolink.clock import ROSClock
from robolink.clock_type import ClockType
from robolink.duration import Duration
from robolink.exceptions import ExternalShutdownException
from robolink.executors import MultiThreadedExecutor, SingleThreadedExecutor
from robolink.interfaces.example_interfaces.action import Fibonacci
from robolink.interfaces.std_msgs.msg import Empty as EmptyMsg
from robolink.interfaces.std_srvs.srv import Empty
from robolink.interfaces.tf2_msgs.action import LookupTransform
from robolink.launch.ros.launch_testing import ActiveIoHandler, ActiveProcInfoHandler
from robolink.launch.ros.launch_testing_ros import WaitForTopics
from robolink.parameter_client import AsyncParameterClient
from robolink.running.timebase import SystemTime
from robolink.system import waits
from robolink.task import Future
from robolink.tf2 import Buffer, BufferClient, TransformListener
from robolink.time import Time
from robolink.wait_for_message import wait_for_message
from tests.support.watched_waits import watched

LONG = 7.0
"""Timeout of the calls, in seconds."""


class Scene:
    """A node whose peers never answer; it is made once the waits are watched, so that its queues are, too."""

    def __init__(self) -> None:
        self.context = Context(transport="memory", time=SystemTime())
        self.context.init()
        self.node = Node("asking", context=self.context, enable_rosout=False)
        self.client = self.node.create_client(Empty, "silent")
        self.action = ActionClient(self.node, Fibonacci, "silent_action")
        self.clock = self.node.get_clock()
        self.silent = Node("silent", context=self.context, enable_rosout=False)

    def serve(self) -> Scene:
        """Announce servers, which nobody spins; return this scene."""
        self.silent.create_service(Empty, "silent", lambda request, response: response)
        ActionServer(self.silent, Fibonacci, "silent_action", lambda goal: Fibonacci.Result())
        return self

    def executor(self, kind: type = SingleThreadedExecutor) -> Any:
        made = kind(context=self.context)
        made.add_node(self.node)
        return made

    def spin_aside(self, executor: Any) -> None:
        def spin() -> None:
            with contextlib.suppress(ExternalShutdownException):
                executor.spin()

        threading.Thread(target=spin, daemon=True).start()

    def busy(self) -> Any:
        """Return an executor with threads, one of which is in a callback that does not end."""
        executor, begun, self.may_end = self.executor(MultiThreadedExecutor), threading.Event(), threading.Event()

        def work() -> None:
            begun.set()
            self.may_end.wait(60.0)

        self.node.create_timer(0.0, work)
        self.spin_aside(executor)
        while not begun.is_set():
            time.sleep(0.001)
        return executor

    def tick_elsewhere(self) -> Any:
        """Return a rate whose timer another thread spins."""
        rate = self.node.create_rate(0.01)
        executor = self.executor()
        self.spin_aside(executor)
        while not executor.spinning:
            time.sleep(0.001)
        return rate

    def close(self) -> None:
        if hasattr(self, "may_end"):
            self.may_end.set()
        self.context.try_shutdown()


def listening(scene: Scene) -> Buffer:
    buffer = Buffer(node=scene.node)
    scene.listener = TransformListener(buffer, scene.node)  # type: ignore[attr-defined]
    return buffer


def asked(scene: Scene) -> BufferClient:
    """Return a client of a server of transforms that does not answer."""
    ActionServer(scene.silent, LookupTransform, "silent_tf", lambda goal: LookupTransform.Result())
    return BufferClient(scene.node, "silent_tf")


def awaited(scene: Scene) -> WaitForTopics:
    made = object.__new__(WaitForTopics)  # it would make a context of its own, on the network
    made.topic_tuples, made.timeout, made._node = [("nothing", EmptyMsg)], LONG, scene.node
    made._all_came, made._is_subscribed, made.qos_profile, made.trigger = threading.Event(), False, 10, None
    return made


def a_player() -> Player:
    made = object.__new__(Player)  # one that plays a long bag
    made.ended = threading.Event()
    return made


CALLS: dict[str, Callable[[Scene], object]] = {
    "wait_for_service": lambda scene: scene.client.wait_for_service(),
    "wait_for_service with a timeout": lambda scene: scene.client.wait_for_service(LONG),
    "wait_for_server": lambda scene: scene.action.wait_for_server(),
    "wait_for_server with a timeout": lambda scene: scene.action.wait_for_server(LONG),
    "wait_for_node": lambda scene: scene.node.wait_for_node("nobody", LONG),
    "wait_for_services of parameters": lambda scene: AsyncParameterClient(scene.node, "nobody").wait_for_services(LONG),
    "call": lambda scene: scene.serve().client.call(Empty.Request()),
    "call with a timeout": lambda scene: scene.serve().client.call(Empty.Request(), LONG),
    "send_goal": lambda scene: scene.serve().action.send_goal(Fibonacci.Goal()),
    "sleep_for": lambda scene: scene.clock.sleep_for(Duration(seconds=LONG), scene.context),
    "sleep_until": lambda scene: scene.clock.sleep_until(scene.clock.now() + Duration(seconds=LONG), scene.context),
    "sleep_until of steady time": lambda scene: sleep_by(rclpy.clock.Clock(clock_type=ClockType.STEADY_TIME), scene),
    "sleep_until of ROS time": lambda scene: sleep_by(ROSClock(), scene),
    "rate.sleep": lambda scene: scene.node.create_rate(0.01).sleep(),
    "rate.sleep beside a thread that spins": lambda scene: scene.tick_elsewhere().sleep(),
    "spin": lambda scene: rclpy.spin(scene.node, scene.executor()),
    "spin_once": lambda scene: rclpy.spin_once(scene.node, executor=scene.executor(), timeout_sec=LONG),
    "spin_until_future_complete": lambda scene: rclpy.spin_until_future_complete(
        scene.node, Future(), scene.executor(), LONG
    ),
    "executor.spin": lambda scene: scene.executor().spin(),
    "executor.spin_once": lambda scene: scene.executor().spin_once(LONG),
    "executor.spin_until_future_complete": lambda scene: scene.executor().spin_until_future_complete(Future(), LONG),
    "spin with threads": lambda scene: scene.executor(MultiThreadedExecutor).spin(),
    "spin_once with threads": lambda scene: scene.executor(MultiThreadedExecutor).spin_once(LONG),
    "shutdown with threads": lambda scene: scene.busy().shutdown(LONG),
    "wait_for_message": lambda scene: wait_for_message(EmptyMsg, scene.node, "nothing"),
    "wait_for_message with a timeout": lambda scene: wait_for_message(
        EmptyMsg, scene.node, "nothing", time_to_wait=LONG
    ),
    "lookup_transform": lambda scene: listening(scene).lookup_transform("a", "b", Time(), Duration(seconds=LONG)),
    "can_transform": lambda scene: listening(scene).can_transform("a", "b", Time(), Duration(seconds=LONG)),
    "lookup_transform of a server": lambda scene: asked(scene).lookup_transform(
        "a", "b", Time(), Duration(seconds=LONG)
    ),
    "wait_until of a launch test's output": lambda scene: ActiveIoHandler().wait_until(lambda: False, LONG),
    "wait_until of a launch test's processes": lambda scene: ActiveProcInfoHandler().wait_until(lambda: False, None),
    "wait of WaitForTopics": lambda scene: awaited(scene).wait(),
    "wait of a bag's player": lambda scene: a_player().wait(LONG),
    "wait_until of the context": lambda scene: scene.context.wait_until(lambda: False, None),
    "wait_for of the graph": lambda scene: scene.context.graph.wait_for(lambda: False, LONG),
}


def sleep_by(clock: rclpy.clock.Clock, scene: Scene) -> None:
    clock.sleep_until(clock.now() + Duration(seconds=LONG), scene.context)


@pytest.mark.parametrize("call", CALLS.values(), ids=CALLS)
def test_no_call_waits_long_in_one_piece(call: Callable[[Scene], object]) -> None:
    with watched() as spy:
        scene = Scene()
        spy.waits.clear()
        try:
            call(scene)
        finally:
            spy.is_off = True
            scene.close()
    assert spy.waits


COMMANDS = [
    "topic echo /nothing",
    "topic echo /nothing std_msgs/msg/Empty",
    "topic hz /nothing",
    "topic bw /nothing",
    "topic delay /nothing",
    "topic pub -w 1 /nothing std_msgs/msg/Empty",
    "topic pub -r 0.1 /nothing std_msgs/msg/Empty",
    "service call /nobody std_srvs/srv/Empty",
    "action send_goal /nobody example_interfaces/action/Fibonacci {}",
    "param get /nobody a --timeout 7",
    "tf echo a b",
    "tf monitor",
    "top",
    pytest.param("view --port 0 --no-browser", marks=pytest.mark.annex("view")),
    "image save /nothing",
    "plot topic /nothing.data --out x.png",
]


@pytest.mark.parametrize("command", COMMANDS)
def test_no_command_waits_long_in_one_piece(command: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("ROBOLINK_TRANSPORT", "memory")
    with watched():
        main(command.split())


def test_a_wait_takes_all_of_its_time() -> None:
    assert list(waits.slices(0.6)) == pytest.approx([0.25, 0.25, 0.1])
    assert list(waits.slices(0.0)) == list(waits.slices(-1.0)) == [0.0]
    begin = time.monotonic()
    assert not waits.wait(threading.Event(), 0.3)
    assert not waits.wait_for(threading.Condition(), lambda: False, 0.3)
    with pytest.raises(queue.Empty):
        waits.get(queue.SimpleQueue(), 0.3)
    with pytest.raises(NotInTime):
        waits.result(ThreadFuture(), 0.3)
    assert time.monotonic() - begin >= 1.2


def test_a_wait_ends_with_what_it_waits_for() -> None:
    future: ThreadFuture[int] = ThreadFuture()
    event, source = threading.Event(), queue.SimpleQueue[int]()

    def act() -> None:
        future.set_result(1)
        source.put(2)
        event.set()

    thread = threading.Thread(target=act)
    thread.start()
    assert (waits.result(future), waits.get(source), waits.wait(event), waits.join(thread)) == (1, 2, True, True)
    failed: ThreadFuture[int] = ThreadFuture()
    failed.set_exception(TimeoutError("its own"))
    with pytest.raises(TimeoutError, match="its own"):
        waits.result(failed)
