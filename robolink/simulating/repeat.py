"""Run a simulation with many seeds, each in a process of its own: what fails there fails again by itself."""

from __future__ import annotations

import os
import signal
import subprocess
import threading
import time
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import Future, ThreadPoolExecutor, as_completed
from contextlib import suppress

import msgspec

from robolink.own_command import own_command
from robolink.simulating.result import SimulationResult

INTERRUPTED = (130, -signal.SIGINT, 0xC000013A)
"""The exit codes of a process that Ctrl-C has ended; the last is what Windows gives to one that had not begun."""

PATIENCE = 1.0
"""Seconds of real time that processes have to end by themselves."""


class SeedRun(msgspec.Struct, frozen=True):
    """What came of one seed: its result, or the error that kept it from having one."""

    seed: int
    result: SimulationResult | None = None
    error: str = ""
    interrupted: bool = False
    """Whether Ctrl-C reached its process, too."""

    @property
    def failures(self) -> list[str]:
        """Why it counts as failed; none if it does not."""
        return [self.error] if self.result is None else self.result.failures


def run_seeds(
    words: Callable[[int], Sequence[str]],
    seeds: Iterable[int],
    *,
    workers: int,
    on_done: Callable[[SeedRun], object] = lambda run: None,
) -> list[SeedRun]:
    """Run `robolink WORDS`, which are to end with a result in JSON, for each seed; give what came of them, in order.

    `workers` run at a time. `on_done` is told of each as it ends. Ctrl-C ends this early, with what has come until
    then; no process is left.
    """
    running = _Running()
    started: list[Future[SeedRun]] = []
    runs: dict[Future[SeedRun], SeedRun] = {}
    with ThreadPoolExecutor(max_workers=workers) as pool:
        try:
            started += [pool.submit(running.run, seed, [*own_command(), *words(seed)]) for seed in seeds]
            for each in as_completed(started):
                if not (run := each.result()).interrupted:
                    runs[each] = run
                    on_done(run)
        except BaseException as error:
            running.end()
            pool.shutdown(wait=True, cancel_futures=True)
            if not isinstance(error, KeyboardInterrupt):
                raise
    return [runs[each] for each in started if each in runs]


class _Running:
    """The processes that run, so that none is left."""

    def __init__(self) -> None:
        self._processes: set[subprocess.Popen[bytes]] = set()
        self._lock = threading.Lock()
        self._ended = False

    def run(self, seed: int, command: Sequence[str]) -> SeedRun:
        with self._lock:
            if self._ended:
                return SeedRun(seed, error="not run")
            process = subprocess.Popen(
                command,
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                env={"PYTHONHASHSEED": "0", **os.environ},  # each run of the same seeds is the same, also with sets
            )
            self._processes.add(process)
        out, err = process.communicate()
        with self._lock:
            self._processes.discard(process)
        return _outcome(seed, process.returncode, out, err)

    def end(self) -> None:
        """Start no more; kill all that run, unless a Ctrl-C that reached them too has them end in order."""
        with self._lock:
            self._ended = True
            running = list(self._processes)
        deadline = time.monotonic() + PATIENCE
        for each in running:
            with suppress(subprocess.TimeoutExpired):
                each.wait(max(0.0, deadline - time.monotonic()))
            each.kill()


def _outcome(seed: int, code: int, out: bytes, err: bytes) -> SeedRun:
    if code in INTERRUPTED:
        return SeedRun(seed, error="interrupted", interrupted=True)
    lines = out.splitlines()
    try:
        return SeedRun(seed, msgspec.json.decode(lines[-1] if lines else b"", type=SimulationResult))
    except msgspec.DecodeError:
        told = err.decode(errors="replace").strip().rpartition("\n")[2]
        return SeedRun(seed, error=told or f"its process ended with exit code {code}")
