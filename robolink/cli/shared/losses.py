"""Losses that the nodes themselves report on /diagnostics, as `topic info -v` and `top` show them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robolink.cli.shared.session import node_of
from robolink.executors import SingleThreadedExecutor
from robolink.node_parts.losses import TOPIC, Losses, losses_in
from robolink.qos import DurabilityPolicy, HistoryPolicy, QoSProfile
from robolink.system import clocks
from robolink.wire import EndpointKind

if TYPE_CHECKING:
    from robolink.context import Context
    from robolink.interfaces.diagnostic_msgs.msg import DiagnosticArray
    from robolink.node import Node

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
        """Return what each subscription has lost, by its gid.

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
        tokens = self._context.graph.endpoints(EndpointKind.PUBLISHER, name=TOPIC)
        latched = [each for each in tokens if each.qos.durability is DurabilityPolicy.TRANSIENT_LOCAL]
        if not latched:
            return
        from robolink.interfaces.diagnostic_msgs.msg import DiagnosticArray

        self._waits_for = {each.full_node_name.strip("/") for each in latched}
        node = self._node or node_of(self._context)
        node.create_subscription(DiagnosticArray, TOPIC, self._on_report, LATCHED)
        self._executor = SingleThreadedExecutor(context=self._context)
        self._executor.add_node(node)

    def _on_report(self, report: DiagnosticArray) -> None:
        self._heard += 1
        self._waits_for -= {each.name.partition(":")[0] for each in report.status}
        self._found.update(losses_in(report))

    def close(self) -> None:
        """Stop listening."""
        if self._executor is not None:
            self._executor.shutdown()
