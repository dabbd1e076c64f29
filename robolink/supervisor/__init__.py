"""Process supervisor: starts, prints, restarts and stops several programs as one system; it knows no nodes.

`policy` has the rules, and the state machine that decides what starts and stops; it knows no processes and no time.
`supervisor` carries out its actions: with `processes`, one child process each, and with `reporting`: terminal, log
files and `events` for programs. Other shells use its `control` socket; `monitoring` watches files, CPU and memory.

Names are imported when they are first used: a node's process needs the lifeline, and nothing of a launcher's.
"""

from typing import TYPE_CHECKING

from robolink.text.suggestions import lazily

if TYPE_CHECKING:
    from robolink.supervisor.events import Event, Status
    from robolink.supervisor.policy import Restarts, Rules
    from robolink.supervisor.processes.lifeline import watch_lifeline
    from robolink.supervisor.processes.process import Process, ProcessStartError
    from robolink.supervisor.reporting.logs import RunLogs
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
    "Process": "processes.process",
    "ProcessStartError": "processes.process",
    "Restarts": "policy",
    "Rules": "policy",
    "RunLogs": "reporting.logs",
    "Status": "events",
    "Supervisor": "supervisor",
    "watch_lifeline": "processes.lifeline",
}

__getattr__, __dir__ = lazily(__name__, _HOMES, ())
