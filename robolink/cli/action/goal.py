"""What `robolink action send_goal` does: it sends a goal, shows what comes of it, and cancels it at Ctrl-C."""

from __future__ import annotations

import contextlib
import signal
import sys
import threading
import time
import uuid
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any, NamedTuple

from robolink.action.graph import FEEDBACK, GET_RESULT, GOAL_TYPE, SEND_GOAL, part_name
from robolink.cli import show
from robolink.cli.asked import Asked, message_of
from robolink.cli.elsewhere import domains_with, hint
from robolink.cli.output import say, tell
from robolink.cli.session import node_of
from robolink.context import Context
from robolink.exceptions import NotFoundError, RobolinkError, nearest, shown
from robolink.interfaces import find, is_named
from robolink.wire import EndpointKind

if TYPE_CHECKING:
    from robolink.action.client import ActionClient, ClientGoalHandle
    from robolink.executors import Executor
    from robolink.interfaces.unique_identifier_msgs.msg import UUID
    from robolink.message import Action
    from robolink.node import Node

PATIENCE = 1.0
"""Seconds without a server after which the reason is given."""

CANCELED_WITHIN = 2.0
"""Seconds that a server has to answer that it cancels the goal."""

_SLICE = 0.25
"""Seconds of one wait: on Windows Ctrl-C does not end a wait that is longer."""

REASONS = {0: "no reason given", 1: "the server goes on", 2: "the server does not know it", 3: "it has ended already"}
"""What the return codes of action_msgs/srv/CancelGoal mean."""

WHOLE = show.Style(longest=None)


class GoalError(RobolinkError, RuntimeError):
    """A goal that cannot be sent, or that nobody answered."""


class Manner(NamedTuple):
    """How a goal is sent, and what is shown of it."""

    feedback: bool = False
    timeout: float = 5.0
    """Seconds until a server has to have accepted or rejected it, the wait for the server included."""
    json: bool = False
    node_name: str = ""

    def say(self, text: str, **plain: Any) -> None:
        """Show text to people, or values to programs: either may be nothing."""
        if not self.json:
            say(text)
        elif plain:
            say(show.as_json({name: show.plain(value) for name, value in plain.items()}))


def run(action: str, type_: str, values: str, manner: Manner) -> int:
    """Send a goal and wait for its end; 0 if it succeeded, else 1. Ctrl-C has it cancelled.

    Raises GoalError when nobody answers in time, ServiceError when the server goes away, NotFoundError for an unknown
    type, DocumentError or EncodeError for a wrong goal.
    """
    with _interruptible() as context:
        from robolink.action.client import ActionClient
        from robolink.executors import SingleThreadedExecutor

        node = node_of(context, manner.node_name)
        asked = Asked(node.resolve_topic_name(action), type_, values)
        deadline = time.monotonic() + manner.timeout
        chosen = _wait_for_type(context, asked, manner, deadline)
        goal = message_of(chosen.Goal, values)
        client = ActionClient(node, chosen, asked.name)
        executor = SingleThreadedExecutor(context=context)
        executor.add_node(node)
        _wait_until(client.server_is_ready, node, deadline, f"{asked.name} has no complete server")
        return _Sending(client, executor, manner).run(goal, asked.name, deadline)


@contextlib.contextmanager
def _interruptible() -> Iterator[Context]:
    """A context that Ctrl-C and SIGTERM do not end, though they break into the block: a goal is cancelled first."""
    numbers = [signal.SIGINT, signal.SIGTERM]
    if sys.platform == "win32":
        numbers.append(signal.SIGBREAK)
    in_main_thread = threading.current_thread() is threading.main_thread()  # elsewhere they cannot be handled
    before = {each: signal.signal(each, signal.default_int_handler) for each in numbers if in_main_thread}
    context = Context()
    try:
        context.init(args=[])
        yield context
    finally:
        context.try_shutdown()
        for number, handler in before.items():
            signal.signal(number, handler if handler is not None else signal.SIG_DFL)


def _wait_for_type(context: Context, asked: Asked, manner: Manner, deadline: float) -> type[Action]:
    """Wait until the action is served, with the type that is named, if one is; give its class."""
    from robolink.cli.types import action_type

    if not _served(context, asked):
        _check_early(asked)
    manner.say("Waiting for an action server to become available...")
    patience = time.monotonic() + PATIENCE
    while not context.graph.wait_for(lambda: _served(context, asked), _SLICE):
        now = time.monotonic()
        if now >= deadline:
            raise GoalError(f"gave up after {manner.timeout:g} s: {_why_absent(context, asked)}")
        if now >= patience:
            patience = float("inf")
            tell(f"waiting: {_why_absent(context, asked)}")
    return action_type(context, asked.name, asked.type_)


def _check_early(asked: Asked) -> None:
    """Find what is wrong with the goal before anybody waits for the server, where its type is installed."""
    if asked.type_:
        with contextlib.suppress(NotFoundError):  # the server may know it
            message_of(find(asked.type_, "action").Goal, asked.values)


def _served(context: Context, asked: Asked) -> bool:
    others = ((EndpointKind.SERVICE, GET_RESULT), (EndpointKind.PUBLISHER, FEEDBACK))
    if not all(context.graph.endpoints(kind, name=part_name(asked.name, part)) for kind, part in others):
        return False
    servers = context.graph.endpoints(EndpointKind.SERVICE, name=part_name(asked.name, SEND_GOAL))
    types = (each.type_name.removesuffix(GOAL_TYPE) for each in servers)
    return any(not asked.type_ or is_named(each, asked.type_) for each in types)


def _why_absent(context: Context, asked: Asked) -> str:
    """Say why there is no such server."""
    mark = part_name("", SEND_GOAL)
    served = [each for each in context.graph.endpoints(EndpointKind.SERVICE) if each.name.endswith(mark)]
    names = {each.name.removesuffix(mark) for each in served}
    types = sorted({each.type_name.removesuffix(GOAL_TYPE) for each in served if each.name == asked.name + mark})
    if types:
        return f"{asked.name} is served as {' and '.join(types)}, not as {shown(asked.type_)}"
    elsewhere = hint(domains_with(context, asked.name + mark, EndpointKind.SERVICE))
    near = "" if elsewhere else nearest(asked.name, sorted(names))
    return f"nobody serves the action {asked.name} on domain {context.get_domain_id()}{elsewhere}{near}"


def _wait_until(condition: Callable[[], bool], node: Node, deadline: float, problem: str) -> None:
    while not node.context.graph.wait_for(condition, _SLICE):
        if time.monotonic() >= deadline:
            raise GoalError(f"gave up: {problem}")


class _Sending:
    """One goal, on its way."""

    def __init__(self, client: ActionClient, executor: Executor, manner: Manner) -> None:
        self._client, self._executor, self._manner = client, executor, manner

    def run(self, goal: Any, name: str, deadline: float) -> int:
        """Send it and show what comes of it; give the exit code."""
        from robolink.interfaces.unique_identifier_msgs.msg import UUID

        goal_id = UUID(uuid=list(uuid.uuid4().bytes))
        self._manner.say(f"Sending goal:\n     {show.as_yaml(goal, WHOLE)}\n")
        on_feedback = self._show_feedback if self._manner.feedback else None
        sent = self._client.send_goal_async(goal, on_feedback, goal_id)
        try:
            self._spin(sent, deadline - time.monotonic())
            if not sent.done():
                raise GoalError(f"{name} did not answer within {self._manner.timeout:g} s whether it accepts the goal")
            return self._follow(sent.result())
        except (KeyboardInterrupt, BrokenPipeError, GoalError):
            self._cancel(goal_id)
            raise

    def _follow(self, handle: ClientGoalHandle | None) -> int:
        from robolink.action.states import NAMES
        from robolink.interfaces.action_msgs.msg import GoalStatus

        assert handle is not None
        number = bytes(handle.goal_id.uuid).hex()
        if not handle.accepted:
            self._manner.say("Goal was rejected.", goal_id=number, accepted=False)
            return 1
        self._manner.say(f"Goal accepted with ID: {number}\n", goal_id=number, accepted=True)
        future = handle.get_result_async()
        self._spin(future)
        response: Any = future.result()
        status = NAMES.get(response.status, str(response.status))
        self._manner.say(f"Result:\n    {show.as_yaml(response.result, WHOLE)}\n")
        self._manner.say(f"Goal finished with status: {status}", status=status, result=response.result)
        return int(response.status != GoalStatus.STATUS_SUCCEEDED)

    def _show_feedback(self, message: Any) -> None:
        feedback = message.feedback
        self._manner.say(f"Feedback:\n    {show.as_yaml(feedback, WHOLE)}\n", feedback=feedback)

    def _cancel(self, goal_id: UUID) -> None:
        """Have the goal cancelled, whether or not it is known yet that it was accepted."""
        with contextlib.suppress(BrokenPipeError):
            self._manner.say("Canceling goal...")
        problem = self._why_not_canceled(goal_id)
        with contextlib.suppress(BrokenPipeError):
            if problem:
                tell(f"robolink: the goal is not cancelled: {problem}")
            else:
                self._manner.say("Goal canceled.", canceled=True)

    def _why_not_canceled(self, goal_id: UUID) -> str:
        from robolink.action.client import ClientGoalHandle

        accepted = self._client.action_type.Impl.SendGoalService.Response(accepted=True)
        future = ClientGoalHandle(self._client, goal_id, accepted).cancel_goal_async()
        self._spin(future, CANCELED_WITHIN)
        if not future.done():
            return f"no answer within {CANCELED_WITHIN:g} s"
        error, answer = future.exception(), None if future.exception() else future.result()
        if answer is None:
            return str(error)
        return "" if answer.goals_canceling else REASONS.get(answer.return_code, f"return code {answer.return_code}")

    def _spin(self, future: Any, seconds: float | None = None) -> None:
        self._executor.spin_until_future_complete(future, None if seconds is None else max(0.0, seconds))
