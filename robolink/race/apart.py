"""Runs of a race in processes of their own, several at a time: no program can end the race, or another one."""

from __future__ import annotations

import os
import sys
import tempfile
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import msgspec

from robolink.learn.process import limit_memory, run_apart, show_own_lines
from robolink.learn.report import Mistake
from robolink.learn.watchdog import Watchdog, end_process
from robolink.race.driving import Drive
from robolink.race.races import RACES, Race
from robolink.race.result import Result
from robolink.system.own_command import own_command

LONGEST = 300.0
"""Seconds of real time after which a run is ended from outside."""

COMMAND = "race-run"
"""Hidden command of the process that runs one program."""


def race_all(
    race: Race, programs: Sequence[str], seed: int, *, on_done: Callable[[Result], object] = lambda result: None
) -> list[Result]:
    """Run programs in a race, as many at a time as there are processors; return their results in the same order.

    Args:
        race: The race.
        programs: Files, or names of nodes.
        seed: Seed of the world and of all chance.
        on_done: Called with each result as it comes.
    """

    def run(program: str) -> Result:
        result = run_one(race, program, seed)
        on_done(result)
        return result

    with ThreadPoolExecutor(max_workers=os.cpu_count() or 1) as pool:
        return list(pool.map(run, programs))


def run_one(race: Race, program: str, seed: int, *, longest: float = LONGEST) -> Result:
    """Run one program in a process of its own.

    Args:
        race: The race.
        program: A file, or the name of a node.
        seed: Seed of the world and of all chance.
        longest: Seconds after which the process is killed.
    """
    path = Path(program)
    what = str(path.resolve()) if path.suffix == ".py" else program
    with tempfile.TemporaryDirectory(prefix="robolink-race-", ignore_cleanup_errors=True) as scratch:
        out, work = Path(scratch, "result.json"), Path(scratch, "work")
        work.mkdir()
        run_apart([*own_command(), COMMAND, race.name, what, str(seed), str(out)], work, longest)
        try:
            result = msgspec.json.decode(out.read_bytes(), type=Result)
        except (OSError, msgspec.DecodeError):
            result = Result(mistake=Mistake("ended all"))
    return msgspec.structs.replace(result, program=program)


def serve(name: str, program: str, seed: int, out: Path) -> None:
    """Run one program in this process, write the result, and end the process.

    Args:
        name: Name of the race.
        program: A file, or the name of a node.
        seed: Seed of the world and of all chance.
        out: File for the result.
    """
    sys.dont_write_bytecode = True
    limit_memory()
    show_own_lines()
    drive = Drive(RACES[name], program, seed)

    def stuck(mistake: Mistake) -> None:
        out.write_bytes(msgspec.json.encode(drive.result(mistake)))
        end_process()

    watchdog = Watchdog(drive, stuck)
    watchdog.start()
    result = drive.run()
    watchdog.stop()
    out.write_bytes(msgspec.json.encode(result))
    end_process()
