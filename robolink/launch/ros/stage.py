"""Stage of real processes for a launch file that goes on, and the launcher's own node."""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

from robolink.exceptions import RobolinkError
from robolink.interfaces.lifecycle_msgs.msg import TransitionEvent
from robolink.interfaces.lifecycle_msgs.srv import ChangeState
from robolink.launch.entry import NODE, Entry
from robolink.supervisor import Process, Supervisor
from robolink.supervisor.director import Request
from robolink.system import waits

if TYPE_CHECKING:
    from robolink.client import Client
    from robolink.context import Context
    from robolink.executors import SingleThreadedExecutor
    from robolink.node import Node
    from robolink.timer import Timer


_LEAVING = 5.0
"""Timeout of leaving the network, in s."""


class NodeThread:
    """Node that is spun on a thread of its own.

    Args:
        make_context: Returns the initialised context of the node.
        say: Called with the reason, if the network cannot be joined.
    """

    def __init__(self, make_context: Callable[[], Context], say: Callable[[str], object]) -> None:
        self._make_context, self._say = make_context, say
        self._executor: SingleThreadedExecutor | None = None
        self._node: Node | None = None
        self._thread: threading.Thread | None = None
        self._has_failed = False

    def __call__(self, act: Callable[[Node], object]) -> None:
        """Call `act` with the node on its thread; with no effect where the network cannot be joined."""
        if self._executor is None and not self._has_failed:
            self._start()
        if self._executor is not None:
            self._executor.create_task(lambda: act(self._own))

    @property
    def _own(self) -> Node:
        assert self._node is not None
        return self._node

    def _start(self) -> None:
        from robolink.executors import SingleThreadedExecutor
        from robolink.node import Node

        try:
            context = self._make_context()
            executor = SingleThreadedExecutor(context=context)
            self._node = Node(NODE, context=context, enable_rosout=False, start_parameter_services=False)
        except (RobolinkError, ValueError) as error:
            self._has_failed = True
            self._say(f"transitions of nodes with a lifecycle cannot be requested: {error}")
            return
        executor.add_node(self._node)
        self._executor = executor
        self._thread = threading.Thread(target=self._spin, args=(context,), name=NODE, daemon=True)
        self._thread.start()

    def _spin(self, context: Context) -> None:
        from robolink.exceptions import ExternalShutdownException

        assert self._executor is not None
        try:
            while context.ok():
                self._executor.spin_once(timeout_sec=0.5)
        except ExternalShutdownException:
            pass

    def __enter__(self) -> NodeThread:
        return self

    def __exit__(self, *_: object) -> None:
        """Leave the network."""
        if self._thread is not None and self._node is not None:
            self._node.context.try_shutdown()
            waits.join(self._thread, _LEAVING)


class ProcessStage:
    """Stage for real processes; it is a context manager, which leaves the network at its end.

    Args:
        supervisor: Supervisor of the processes.
        plan: Returns the processes in which entries run.
        make_context: Returns the initialised context of the launcher's own node; None is one of the environment's.
    """

    def __init__(
        self,
        supervisor: Supervisor,
        plan: Callable[[list[Entry]], Sequence[Process]],
        make_context: Callable[[], Context] | None = None,
    ) -> None:
        self._supervisor, self._plan = supervisor, plan
        self._node = NodeThread(make_context or own_context, supervisor.say)

    def plan(self, entries: list[Entry]) -> Sequence[Process]:
        """Return the processes in which entries run that are added while the system runs."""
        return self._plan(entries)

    def with_node(self, act: Callable[[Node], object]) -> None:
        """Call `act` with the launcher's own node, on its thread."""
        self._node(act)

    def post(self, act: Callable[[float], Sequence[Request[Process]]]) -> None:
        """Call `act` with the time in the supervisor's loop."""
        self._supervisor.direct(act)

    def __enter__(self) -> ProcessStage:
        return self

    def __exit__(self, *details: object) -> None:
        self._node.__exit__(*details)


def own_context() -> Context:
    """Return the initialised context of the launcher's own node, for the environment's domain."""
    from robolink.context import Context

    context = Context()
    context.init([])
    return context


LOOK_AGAIN = 0.05
"""Interval between two looks for a service, in s."""
PATIENCE = 10.0
"""Time after which a service that is still missing is reported, in s."""


class Lifecycles:
    """Client of nodes with a lifecycle.

    Args:
        with_node: Calls a function with the launcher's own node, where that is spun.
        on_transition: Called there with the full name of a node and the event of each of its transitions.
        say: Called there with a line for people.
    """

    def __init__(
        self,
        with_node: Callable[[Callable[[Node], object]], None],
        on_transition: Callable[[str, TransitionEvent], object],
        say: Callable[[str], object],
    ) -> None:
        self._with_node, self._on_transition, self._say = with_node, on_transition, say
        self._watched: set[str] = set()
        self._clients: dict[str, Client] = {}

    def watch(self, name: str) -> None:
        """Hear of the transitions of the node with the full name `name`."""
        if name in self._watched:
            return
        self._watched.add(name)

        def subscribe(node: Node) -> None:
            topic = f"{name}/transition_event"
            node.create_subscription(TransitionEvent, topic, lambda event: self._on_transition(name, event), 10)

        self._with_node(subscribe)

    def change(self, name: str, transition_id: int) -> None:
        """Ask the node with the full name `name` for a transition, once it serves that."""
        self.watch(name)
        self._with_node(lambda node: _Change(node, self._client(node, name), name, transition_id, self._say))

    def _client(self, node: Node, name: str) -> Client:
        if name not in self._clients:
            self._clients[name] = node.create_client(ChangeState, f"{name}/change_state")
        return self._clients[name]


class _Change:
    """One request for a transition, which waits until its service is there."""

    def __init__(self, node: Node, client: Client, name: str, transition_id: int, say: Callable[[str], object]) -> None:
        self._node, self._client, self._name, self._say = node, client, name, say
        self._request = ChangeState.Request()
        self._request.transition.id = transition_id
        self._left = round(PATIENCE / LOOK_AGAIN)
        self._timer: Timer = node.create_timer(LOOK_AGAIN, self._look)

    def _look(self) -> None:
        if self._client.service_is_ready():
            self._node.destroy_timer(self._timer)
            self._client.call_async(self._request).add_done_callback(self._answered)
            return
        self._left -= 1
        if self._left == 0:
            self._say(f"{self._name} has no lifecycle yet: it is to make transition {self._request.transition.id}")

    def _answered(self, future: Any) -> None:
        if future.exception() is not None or not future.result().success:
            self._say(f"{self._name} did not make transition {self._request.transition.id}")
