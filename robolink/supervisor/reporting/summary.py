"""Summary of the failures of a run: which process ended how, why, and how often."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass


@dataclass
class Failures:
    """Last failure of a process in words, and the number of its failures."""

    last: str
    times: int = 0
    restarts: int = 0


class Summary:
    """Collects failures; `lines` describes them."""

    def __init__(self) -> None:
        self._failures: dict[str, Failures] = {}

    def failed(self, name: str, how: str, *, restarts: int, was_asked: bool) -> None:
        """Note a failure: `world was killed by SIGSEGV`, also of a process that had been asked to stop."""
        failures = self._failures.setdefault(name, Failures(how))
        failures.last = f"{how} (when asked to stop)" if was_asked else how
        failures.times += 1
        failures.restarts = restarts

    def lines(self, still_running: Iterable[str] = ()) -> list[str]:
        """Return a line for each process that failed, in the order of their first failures."""
        told = [_told(each) for each in self._failures.values()]
        return told + [f"{name} still runs: it could not be killed" for name in still_running]


def _told(failures: Failures) -> str:
    if failures.times == 1 and failures.restarts == 0:
        return failures.last
    failed = f"failed {failures.times} times, " if failures.times > 1 else ""
    times = "once" if failures.restarts == 1 else f"{failures.restarts} times"
    return f"{failures.last} ({failed}started again {times})"
