"""Short-lived contexts in which commands look at a running system, calls of its services, and reported losses."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any

from robolink.context import Context
from robolink.exceptions import RobolinkError, ServiceError
from robolink.qos import DurabilityPolicy, HistoryPolicy, QoSProfile
from robolink.signals import install_signal_handlers
from robolink.system import clocks
from robolink.wire import EndpointKind

if TYPE_CHECKING:
    from robolink.executors import SingleThreadedExecutor
    from robolink.interfaces.diagnostic_msgs.msg import DiagnosticArray
    from robolink.node import Node
    from robolink.node_parts.losses import Losses


_left: list[Context] = []
"""Contexts that `looking` has left open."""


@contextlib.contextmanager
def opened(enclave: str = "") -> Iterator[Context]:
    """Open a context for the block, with a handler for Ctrl-C, and shut it down at the end.

    Args:
        enclave: Enclave whose keys and rights it has, where security is on; '' for `/`.
    """
    context = _initialized(enclave)
    try:
        yield context
    finally:
        context.try_shutdown()


@contextlib.contextmanager
def looking() -> Iterator[Context]:
    """Open a context for a command that only looks at what is announced, and then ends.

    It is left open: closing a session that has 30 peers takes 0.3 s, and nothing of it needs a farewell.
    """
    context = _initialized()
    _left.append(context)
    yield context


def close_looks() -> None:
    """Shut down the contexts that `looking` has left open: for a process that goes on."""
    while _left:
        _left.pop().try_shutdown()


def any_looks() -> bool:
    """True if `looking` has left a context open."""
    return bool(_left)


def _initialized(enclave: str = "") -> Context:
    context = Context()
    context.init(args=["--ros-args", "--enclave", enclave] if enclave else [])
    install_signal_handlers()
    return context


def node_of(context: Context, name: str = "", *, describes: bool = False) -> Node:
    """Make the node that a command speaks through: with a hidden name, unless it is given one.

    It has no services, but for that of type descriptions if it `describes` the types that it uses.
    """
    from robolink.node import Node
    from robolink.parameter import Parameter

    return Node(
        name or f"_robolink_cli_{os.getpid()}",
        context=context,
        enable_rosout=False,
        start_parameter_services=False,
        parameter_overrides=[Parameter("start_type_description_service", value=describes)],
    )


def call_all(
    context: Context,
    srv_type: type[Any],
    requests: dict[str, Any],
    within: float,
    no_answer: Callable[[str], RobolinkError],
) -> dict[str, Any]:
    """Call services, all at once, and return the response of each, or its error, by the service's name.

    Args:
        context: Context in which a node of its own asks.
        srv_type: Type of the services.
        requests: Request by service.
        within: Timeout of all answers, in seconds.
        no_answer: Makes the error of a service that does not answer in time.
    """
    from robolink.executors import SingleThreadedExecutor  # late: most commands spin nothing

    deadline = clocks.monotonic() + within
    with SingleThreadedExecutor(context=context) as executor:
        asker = node_of(context)
        executor.add_node(asker)
        futures = {name: asker.create_client(srv_type, name).try_call_async(each) for name, each in requests.items()}
        for future in futures.values():
            executor.spin_until_future_complete(future, timeout_sec=max(0.0, deadline - clocks.monotonic()))
            if not context.ok():
                raise KeyboardInterrupt
        answers = {name: _answer(name, future, no_answer) for name, future in futures.items()}
        asker.destroy_node()
    return answers


def _answer(service: str, future: Any, no_answer: Callable[[str], RobolinkError]) -> Any:
    if not future.done():
        return no_answer(service)
    try:
        return future.result()
    except ServiceError as error:
        return error


LATCHED = QoSProfile(history=HistoryPolicy.KEEP_ALL, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class ReportedLosses:
    """Listener to the reports of all nodes; it subscribes once there is one who reports: nobody does before a loss.

    Args:
        context: Context of the command.
        node: Hidden node of the command, which nobody else spins; None makes one when it is needed.
    """

    def __init__(self, context: Context, node: Node | None = None) -> None:
        self._context, self._node = context, node
        self._found: dict[bytes, Losses] = {}
        self._waits_for: set[str] = set()
        self._executor: SingleThreadedExecutor | None = None
        self._heard = 0

    def look(self, within: float = 0.0) -> dict[bytes, Losses]:
        """Return the losses of each subscription, by its gid.

        Args:
            within: Longest wait for those who report and were not heard yet, in seconds.
        """
        if self._executor is None:
            self._listen()
        if self._executor is None:
            return {}
        end = clocks.monotonic() + within
        heard = -1
        while heard != self._heard or (self._waits_for and clocks.monotonic() < end):
            heard = self._heard
            self._executor.spin_once(timeout_sec=max(0.0, end - clocks.monotonic()) if self._waits_for else 0.0)
        return dict(self._found)

    def _listen(self) -> None:
        from robolink.node_parts.losses import TOPIC

        tokens = self._context.graph.endpoints(EndpointKind.PUBLISHER, name=TOPIC)
        latched = [each for each in tokens if each.qos.durability is DurabilityPolicy.TRANSIENT_LOCAL]
        if not latched:
            return
        from robolink.executors import SingleThreadedExecutor
        from robolink.interfaces.diagnostic_msgs.msg import DiagnosticArray

        self._waits_for = {each.full_node_name.strip("/") for each in latched}
        node = self._node or node_of(self._context)
        node.create_subscription(DiagnosticArray, TOPIC, self._on_report, LATCHED)
        self._executor = SingleThreadedExecutor(context=self._context)
        self._executor.add_node(node)

    def _on_report(self, report: DiagnosticArray) -> None:
        from robolink.node_parts.losses import losses_in

        self._heard += 1
        self._waits_for -= {each.name.partition(":")[0] for each in report.status}
        self._found.update(losses_in(report))

    def close(self) -> None:
        """Stop listening."""
        if self._executor is not None:
            self._executor.shutdown()
