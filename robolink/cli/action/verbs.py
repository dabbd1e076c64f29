"""The verbs of actions: lists with types, the nodes of an action, and goals with their feedback."""

from __future__ import annotations

import contextlib
import math
import signal
import sys
import threading
import uuid
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any, NamedTuple

from robolink.cli.shared import messages
from robolink.cli.shared.graph import absolute, domains_with, endpoints, hint, sections_of
from robolink.cli.shared.messages import GivenRequest, message_of
from robolink.cli.shared.output import say, say_json, tell
from robolink.cli.shared.session import looking, node_of
from robolink.context import Context
from robolink.exceptions import NotFoundError, RobolinkError, nearest
from robolink.graph.action_names import FEEDBACK, GET_RESULT, GOAL_TYPE, SEND_GOAL, part_name
from robolink.interfaces import find, is_named
from robolink.system import clocks
from robolink.system.terminal import shown
from robolink.wire import EndpointKind

if TYPE_CHECKING:
    from robolink.action.client import ActionClient, ClientGoalHandle
    from robolink.executors import Executor
    from robolink.interfaces.unique_identifier_msgs.msg import UUID
    from robolink.message import Action
    from robolink.node import Node
    from robolink.wire import EndpointToken


TITLES = {"Action clients": "Action Clients", "Action servers": "Action Servers"}
"""Printed titles, each with the section of `node info` that it is made from."""


def show(action: str, *, types: bool, count: bool, as_json: bool) -> None:
    """Show the servers and clients. Raises NotFoundError for an action that has neither."""
    name = absolute(action)
    with looking() as context:
        nodes = _nodes(endpoints(context))
    users = {
        title: {node: used[title][name] for node, used in nodes.items() if name in used[title]} for title in TITLES
    }
    if not any(users.values()):
        known = {each for used in nodes.values() for actions in used.values() for each in actions}
        raise NotFoundError("action", shown(name), known, f"domain {context.get_domain_id()}")
    if as_json:
        say_json({"name": name, **{title.lower().replace(" ", "_"): found for title, found in users.items()}})
        return
    say(f"Action: {name}")
    for title, found in users.items():
        say(f"{title}: {len(found)}")
        for node, its_types in found.items() if not count else ():
            say(f"    {node} [{', '.join(its_types)}]" if types else f"    {node}")


def _nodes(ends: list[EndpointToken]) -> dict[str, dict[str, dict[str, list[str]]]]:
    """Return, for each node, the actions that it is a client of and that it serves, each with its types."""
    of_node: dict[str, list[EndpointToken]] = {}
    for each in ends:
        of_node.setdefault(each.full_node_name, []).append(each)
    found = {}
    for node in sorted(of_node):
        sections = dict(sections_of(of_node[node], hidden=True))
        found[node] = {title: dict(sections[section]) for title, section in TITLES.items()}
    return found


PATIENCE = 1.0
"""Wait for a server until the reason is printed, in seconds."""

CANCELED_WITHIN = 2.0
"""Timeout of the answer to a cancellation, in seconds."""

_SLICE = 0.25
"""Longest single wait, in seconds: on Windows Ctrl-C does not end a wait."""

REASONS = {
    0: "the server goes on",
    1: "the server goes on",
    2: "the server does not know it",
    3: "it has ended already",
}
"""Meaning of the return codes of action_msgs/srv/CancelGoal."""

WHOLE = messages.Style(longest=None)


class GoalError(RobolinkError, RuntimeError):
    """A goal cannot be sent, or was not answered."""


class Mode(NamedTuple):
    """Options of `send_goal`: how a goal is sent, and what is shown of it."""

    feedback: bool = False
    timeout: float = 5.0
    """Timeout until the goal is accepted or rejected, in seconds, with the wait for the server."""
    json: bool = False
    node_name: str = ""

    def say(self, text: str, **plain: Any) -> None:
        """Print `text`, or with --json the values; either may be empty, and is not printed then."""
        if not self.json:
            say(text)
        elif plain:
            say(messages.as_json({name: messages.plain(value) for name, value in plain.items()}))


def run(action: str, type_: str, values: str, mode: Mode) -> int:
    """Send a goal and wait for its end; return 0 if it succeeded, else 1. Ctrl-C cancels the goal.

    Raises GoalError if there is no answer in time, ServiceError if the server goes away, NotFoundError for an unknown
    type, DocumentError or EncodeError for a wrong goal.
    """
    with _interruptible() as context:
        from robolink.action.client import ActionClient
        from robolink.executors import SingleThreadedExecutor

        node = node_of(context, mode.node_name)
        given = GivenRequest(node.resolve_topic_name(action), type_, values)
        deadline = clocks.monotonic() + mode.timeout
        chosen = _wait_for_type(context, given, mode, deadline)
        goal = message_of(chosen.Goal, values)
        client = ActionClient(node, chosen, given.name)
        executor = SingleThreadedExecutor(context=context)
        executor.add_node(node)
        _wait_until(client.server_is_ready, node, deadline, f"{given.name} has no complete server")
        return _Sending(client, executor, mode).run(goal, given.name, deadline)


@contextlib.contextmanager
def _interruptible() -> Iterator[Context]:
    """Open a context that outlives Ctrl-C and SIGTERM, which interrupt only the block: a goal is cancelled first."""
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


def _wait_for_type(context: Context, given: GivenRequest, mode: Mode, deadline: float) -> type[Action]:
    """Wait until the action is served, with the type that is named, if one is; return its class."""
    from robolink.cli.shared.messages import action_type

    if not _is_served(context, given):
        _check_early(given)
    mode.say("Waiting for an action server to become available...")
    patience = clocks.monotonic() + PATIENCE
    while not context.graph.wait_for(lambda: _is_served(context, given), _SLICE):
        now = clocks.monotonic()
        if now >= deadline:
            raise GoalError(f"gave up after {mode.timeout:g} s: {_why_absent(context, given)}")
        if now >= patience:
            patience = float("inf")
            tell(f"waiting: {_why_absent(context, given)}")
    return action_type(context, given.name, given.type_)


def _check_early(given: GivenRequest) -> None:
    """Check the goal before the wait for the server, if its type is installed."""
    if given.type_:
        with contextlib.suppress(NotFoundError):  # the server may know it
            message_of(find(given.type_, "action").Goal, given.values)


def _is_served(context: Context, given: GivenRequest) -> bool:
    others = ((EndpointKind.SERVICE, GET_RESULT), (EndpointKind.PUBLISHER, FEEDBACK))
    if not all(context.graph.endpoints(kind, name=part_name(given.name, part)) for kind, part in others):
        return False
    servers = context.graph.endpoints(EndpointKind.SERVICE, name=part_name(given.name, SEND_GOAL))
    types = (each.type_name.removesuffix(GOAL_TYPE) for each in servers)
    return any(not given.type_ or is_named(each, given.type_) for each in types)


def _why_absent(context: Context, given: GivenRequest) -> str:
    """Return the reason why there is no such server."""
    mark = part_name("", SEND_GOAL)
    served = [each for each in context.graph.endpoints(EndpointKind.SERVICE) if each.name.endswith(mark)]
    names = {each.name.removesuffix(mark) for each in served}
    types = sorted({each.type_name.removesuffix(GOAL_TYPE) for each in served if each.name == given.name + mark})
    if types:
        return f"{given.name} is served as {' and '.join(types)}, not as {shown(given.type_)}"
    elsewhere = hint(domains_with(context, given.name + mark, EndpointKind.SERVICE))
    near = "" if elsewhere else nearest(given.name, sorted(names))
    return f"nobody serves the action {given.name} on domain {context.get_domain_id()}{elsewhere}{near}"


def _wait_until(condition: Callable[[], bool], node: Node, deadline: float, problem: str) -> None:
    while not node.context.graph.wait_for(condition, _SLICE):
        if clocks.monotonic() >= deadline:
            raise GoalError(f"gave up: {problem}")


class _Sending:
    """A goal that has been sent, with its feedback and result."""

    def __init__(self, client: ActionClient, executor: Executor, mode: Mode) -> None:
        self._client, self._executor, self._mode = client, executor, mode
        self._unheard: OSError | None = None
        """Error of the output, once nobody reads the feedback any more."""

    def run(self, goal: Any, name: str, deadline: float) -> int:
        """Send the goal, show feedback and result, and return the exit code."""
        from robolink.interfaces.unique_identifier_msgs.msg import UUID

        goal_id = UUID(uuid=list(uuid.uuid4().bytes))
        self._mode.say(f"Sending goal:\n     {messages.as_yaml(goal, WHOLE)}\n")
        on_feedback = self._show_feedback if self._mode.feedback else None
        sent = self._client.send_goal_async(goal, on_feedback, goal_id)
        try:
            self._spin(sent, deadline - clocks.monotonic())
            if not sent.done():
                raise GoalError(f"{name} did not answer within {self._mode.timeout:g} s whether it accepts the goal")
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
            self._mode.say("Goal was rejected.", goal_id=number, accepted=False)
            return 1
        self._mode.say(f"Goal accepted with ID: {number}\n", goal_id=number, accepted=True)
        future = handle.get_result_async()
        self._spin(future)
        response: Any = future.result()
        status = NAMES.get(response.status, str(response.status))
        self._mode.say(f"Result:\n    {messages.as_yaml(response.result, WHOLE)}\n")
        self._mode.say(f"Goal finished with status: {status}", status=status, result=response.result)
        return int(response.status != GoalStatus.STATUS_SUCCEEDED)

    def _show_feedback(self, message: Any) -> None:
        if self._unheard is not None:
            return
        feedback = message.feedback
        try:
            self._mode.say(f"Feedback:\n    {messages.as_yaml(feedback, WHOLE)}\n", feedback=feedback)
        except OSError as error:  # raised where it is waited for: a callback that raises is logged
            self._unheard = error

    def _cancel(self, goal_id: UUID) -> None:
        """Cancel the goal, even if the answer is not known yet that it was accepted."""
        with contextlib.suppress(BrokenPipeError):
            self._mode.say("Canceling goal...")
        problem = self._why_not_canceled(goal_id)
        with contextlib.suppress(BrokenPipeError):
            if problem:
                tell(f"robolink: the goal is not cancelled: {problem}")
            else:
                self._mode.say("Goal canceled.", canceled=True)

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
        """Wait for a future; raise the error of the output if its reader goes meanwhile."""
        before, deadline = self._unheard, math.inf if seconds is None else clocks.monotonic() + max(0.0, seconds)
        while not future.done() and self._unheard is before and (left := deadline - clocks.monotonic()) > 0.0:
            self._executor.spin_once_until_future_complete(future, None if left == math.inf else left)
        if self._unheard is not None and self._unheard is not before:
            raise self._unheard
