"""Run several programs as one system: start, print, decide, stop; it knows no nodes.

`process` runs one, `printer` is the only place that prints, `policy` the only one that decides, `supervisor`
joins them. `lifeline` and `guardian` see to it that nothing stays behind when the supervisor itself is killed.
"""

from robolink.supervisor.lifeline import watch_lifeline
from robolink.supervisor.process import Process, ProcessStartError
from robolink.supervisor.supervisor import Supervisor

__all__ = ["Process", "ProcessStartError", "Supervisor", "watch_lifeline"]
