"""A node's process that is interrupted while Python still imports ends as one that is interrupted later: in silence."""

from __future__ import annotations

import io
import sys
from collections.abc import Callable

import pytest

from robolink.supervisor import Process, Supervisor

pytestmark = pytest.mark.processes

if sys.platform == "win32":
    pytest.skip("signals cannot be held back there", allow_module_level=True)

IMPORTING = """
import signal, sys
def is_held():
    return signal.SIGINT in signal.pthread_sigmask(signal.SIG_BLOCK, [])
print("held", is_held(), flush=True)
from robolink.supervisor.processes.lifeline import watch_lifeline
try:
    while signal.SIGINT not in signal.sigpending():
        pass
    watch_lifeline()
    while True:
        signal.pause()
except KeyboardInterrupt:
    print("held", is_held(), flush=True)
    sys.exit(130)
"""


class Output(io.StringIO):
    """Acts when a line begins with certain words."""

    def __init__(self, word: str, act: Callable[[], object]) -> None:
        super().__init__()
        self._word, self._act = word, act

    def write(self, text: str) -> int:
        if self._word in text:
            self._act()
        return super().write(text)


def test_an_interrupt_waits_for_those_who_hold_it() -> None:
    process = Process("node", [sys.executable, "-c", IMPORTING], holds_interrupts=True)
    output = Output("[node] held True", lambda: supervisor.stop())
    supervisor = Supervisor([process], output=output)
    assert supervisor.run() == 0
    first, stopping, last = output.getvalue().splitlines()
    assert (first, last) == ("[node] held True", "[node] held False")
    assert stopping.startswith("[launch] stopping")


def test_others_can_be_interrupted_at_once() -> None:
    output = io.StringIO()
    look = "import signal; print(signal.SIGINT in signal.pthread_sigmask(signal.SIG_BLOCK, []))"
    Supervisor([Process("command", [sys.executable, "-c", look])], output=output).run()
    assert "[command] False\n" in output.getvalue()
