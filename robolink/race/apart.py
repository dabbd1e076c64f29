"""Runs of a race in processes of their own, several at a time: no program can end the race, or another one."""

from __future__ import annotations

import os
import threading
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import msgspec

from robolink.learn.process import run_apart
from robolink.race.races import RACES, Race
from robolink.race.result import Result
from robolink.system import waits
from robolink.workspace import user_workspace
from robolink.workspace.find import VARIABLE

LONGEST = 300.0
"""Seconds of real time after which a run is ended from outside."""

COMMAND = "race-run"
"""Hidden command of the process that runs one program."""


def race_all(
    race: Race, programs: Sequence[str], seed: int, *, on_done: Callable[[Result], object] = lambda result: None
) -> list[Result]:
    """Run programs in a race, as many at a time as there are processors; return their results in the same order.

    Whatever interrupts it ends the programs that run.

    Args:
        race: The race.
        programs: Files, or names of nodes.
        seed: Seed of the world and of all chance.
        on_done: Called with each result as it comes.
    """
    stop = threading.Event()

    def run(program: str) -> Result:
        result = run_one(race, program, seed, stop=stop)
        on_done(result)
        return result

    with ThreadPoolExecutor(max_workers=os.cpu_count() or 1) as pool:
        try:
            return [waits.result(each) for each in [pool.submit(run, program) for program in programs]]
        except BaseException:
            stop.set()
            pool.shutdown(wait=False, cancel_futures=True)
            raise


def run_one(
    race: Race, program: str, seed: int, *, longest: float = LONGEST, stop: threading.Event | None = None
) -> Result:
    """Run one program in a process of its own.

    Args:
        race: The race.
        program: A file, or the name of a node.
        seed: Seed of the world and of all chance.
        longest: Seconds after which the process is killed.
        stop: Event that ends the run; None for none.
    """
    file = Path(program)
    what = str(file.resolve()) if file.is_file() else program
    workspace = user_workspace()  # the process works elsewhere, and is to find the same nodes
    ended = run_apart(
        [COMMAND, race.name, str(seed), what],
        file.resolve(),
        longest,
        stop=stop,
        variables={} if workspace is None else {VARIABLE: str(workspace)},
    )
    try:
        result = msgspec.json.decode(ended.answer, type=Result)
    except msgspec.DecodeError:
        result = Result(mistake=ended.mistake)
    return msgspec.structs.replace(result, program=program)


def serve(name: str, program: str, seed: int, answer: Path) -> None:
    """Run one program in this process, which that ends: the other side of `run_one`.

    Args:
        name: Name of the race.
        program: A file, or the name of a node.
        seed: Seed of the world and of all chance.
        answer: File for the result.
    """
    from robolink.learn.child import Child  # late: whoever asks for a run needs none of it
    from robolink.race.driving import Drive

    child = Child(answer)
    drive = Drive(RACES[name], program, seed)
    child.watch(drive, drive.result)
    child.end(drive.run())
