"""Run several programs as one system: start, print, decide, stop; it knows no nodes.

`policy`, by `rules`, decides what starts and stops and knows neither processes nor the time. `supervisor` does what it
says: with `processes`, one program each and what sees to it that none stays behind, and with `telling`, the terminal,
log files and `events` for programs. Other shells ask at its `door`; `watching` looks at files, CPU and memory.

Names are imported when they are first used: a node's process wants the lifeline, and nothing of a launcher's.
"""

from typing import TYPE_CHECKING

from robolink.lacking import lazily

if TYPE_CHECKING:
    from robolink.supervisor.events import Event, Status
    from robolink.supervisor.processes.lifeline import watch_lifeline
    from robolink.supervisor.processes.process import Process, ProcessStartError
    from robolink.supervisor.rules import Restarts, Rules
    from robolink.supervisor.supervisor import Supervisor
    from robolink.supervisor.telling.logs import RunLogs

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
    "Process": "processes.process",
    "ProcessStartError": "processes.process",
    "Restarts": "rules",
    "Rules": "rules",
    "RunLogs": "telling.logs",
    "Status": "events",
    "Supervisor": "supervisor",
    "watch_lifeline": "processes.lifeline",
}

__getattr__, __dir__ = lazily(__name__, _HOMES, ())
