"""Runs of a race in processes of their own, several at a time: no program ends the race, or wins by ending another one.

They are processes of one user, so that one can end another, or spoil its answer. Who has none is run again, alone.
"""

from __future__ import annotations

import os
import threading
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import msgspec

from robolink.exceptions import NotFoundError
from robolink.grading.mistakes import Mistake
from robolink.grading.process import run_apart
from robolink.race.races import RACES, Race
from robolink.race.result import Result
from robolink.system import waits
from robolink.workspace import find_node, user_workspace
from robolink.workspace.find import VARIABLE

LONGEST = 300.0
"""Seconds of real time after which a run is ended from outside."""

COMMAND = "race-run"
"""Hidden command of the process that runs one program."""


def race_all(
    race: Race, programs: Sequence[str], seed: int, *, on_done: Callable[[Result], object] = lambda result: None
) -> list[Result]:
    """Run programs in a race, as many at a time as there are processors; return their results in the same order.

    Whatever interrupts it ends the programs that run. A program that ended without an answer may have been ended by
    another one: it is run again once all others are over, by itself.

    Args:
        race: The race.
        programs: Files, or names of nodes.
        seed: Seed of the world and of all chance.
        on_done: Called with each result as it comes.
    """
    stop = threading.Event()

    def run(program: str) -> Result | None:
        result = _answered(race, program, seed, LONGEST, stop)[0]
        if result is not None:
            on_done(result)
        return result

    with ThreadPoolExecutor(max_workers=os.cpu_count() or 1) as pool:
        try:
            found = [waits.result(each) for each in [pool.submit(run, program) for program in programs]]
            results = []
            for program, result in zip(programs, found, strict=True):
                results.append(result or waits.result(pool.submit(run_one, race, program, seed, stop=stop)))
                if result is None:
                    on_done(results[-1])
        except BaseException:
            stop.set()
            pool.shutdown(wait=False, cancel_futures=True)
            raise
        return results


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
    result, mistake = _answered(race, program, seed, longest, stop)
    return result or Result(program, mistake=mistake)


def _answered(
    race: Race, program: str, seed: int, longest: float, stop: threading.Event | None
) -> tuple[Result | None, Mistake]:
    """Run one program; return its result, None if it gave none, and the mistake that explains that."""
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
        return None, ended.mistake
    return msgspec.structs.replace(result, program=program), ended.mistake


def serve(name: str, program: str, seed: int, answer: Path) -> None:
    """Run one program in this process, which that ends: the other side of `run_one`.

    Args:
        name: Name of the race.
        program: A file, or the name of a node.
        seed: Seed of the world and of all chance.
        answer: File for the result.
    """
    from robolink.grading.child import Child  # late: whoever asks for a run needs none of it
    from robolink.race.driving import Drive

    child = Child(answer)
    drive = Drive(RACES[name], program, seed)
    child.watch(drive, drive.result)
    child.end(drive.run())


def programs_of(race: str, words: Iterable[str]) -> list[str]:
    """Return the programs that words of a command line stand for.

    A folder stands for the Python files in it, and for one of each folder in it: `RACE.py`, or the only one.

    Args:
        race: Name of the race.
        words: Files, folders, or names of nodes as `robolink run` finds them.

    Raises:
        NotFoundError: if a word is none of them, or nothing is found in a folder.
    """
    return [program for word in words for program in _of_word(race, word)]


def without_program(race: str, words: Iterable[str]) -> list[str]:
    """Return the students' folders in which there is no program for a race, or nobody knows which of several it is.

    Args:
        race: Name of the race.
        words: Files, folders, or names of nodes, as for `programs_of`.
    """
    students = [student for word in words if Path(word).is_dir() for student in _students(Path(word))]
    return sorted(str(each) for each in students if _own(race, each) is None)


def _of_word(race: str, word: str) -> list[str]:
    path = Path(word)
    if path.is_dir():
        found = sorted(map(str, _in_folder(race, path)))
        if not found:
            raise NotFoundError("program", f"*.py or */{race}.py", [], word)
        return found
    if path.is_file():
        return [word]
    if path.suffix == ".py" or len(path.parts) > 1:
        raise NotFoundError("file", word, (str(each) for each in path.parent.glob("*.py")))
    find_node(word)  # raises with the nearest name
    return [word]


def _in_folder(race: str, folder: Path) -> Iterator[Path]:
    yield from (each for each in folder.glob("*.py") if each.is_file())
    yield from (own for student in _students(folder) if (own := _own(race, student)) is not None)


def _students(folder: Path) -> list[Path]:
    return [each for each in folder.iterdir() if each.is_dir() and not each.name.startswith((".", "_"))]


def _own(race: str, student: Path) -> Path | None:
    """Return the program of a student's folder; None if there is none, or nobody knows which."""
    own = student / f"{race}.py"
    files = [own] if own.is_file() else list(student.glob("*.py"))
    return files[0] if len(files) == 1 else None
