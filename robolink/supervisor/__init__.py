"""Run several programs as one system: start, print, decide, stop; it knows no nodes.

`process` runs one, `printer` is the only place that prints, `policy` (with `rules`) the only one that decides,
`supervisor` joins them. What is told goes through `telling` to the printer, to `logs` and, as `events`, to `notifier`;
`causes` finds why a program ended, `summary` says it at the end. `lifeline` and `guardian` see to it that nothing
stays behind when the supervisor itself is killed.

Names are imported when they are first used: a node's process wants the lifeline, and nothing of a launcher's.
"""

from typing import TYPE_CHECKING

from robolink.lacking import lazily

if TYPE_CHECKING:
    from robolink.supervisor.events import Event, Status
    from robolink.supervisor.lifeline import watch_lifeline
    from robolink.supervisor.logs import RunLogs
    from robolink.supervisor.process import Process, ProcessStartError
    from robolink.supervisor.rules import Restarts, Rules
    from robolink.supervisor.supervisor import Supervisor

__all__ = [
    "Event",
    "Process",
    "ProcessStartError",
    "Restarts",
    "Rules",
    "RunLogs",
    "Status",
    "Supervisor",
    "watch_lifeline",
]

_HOMES = {
    "Event": "events",
    "Process": "process",
    "ProcessStartError": "process",
    "Restarts": "rules",
    "Rules": "rules",
    "RunLogs": "logs",
    "Status": "events",
    "Supervisor": "supervisor",
    "watch_lifeline": "lifeline",
}

__getattr__, __dir__ = lazily(__name__, _HOMES, ())
