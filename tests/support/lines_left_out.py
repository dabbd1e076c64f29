"""Solutions of the exercises without one of their lines, each line in turn: no check may break, or take long.

python -m tests.support.lines_left_out [EXERCISE...]     some minutes; ends with 1 if a check was at fault
"""

from __future__ import annotations

import contextlib
import io
import sys
import tempfile
import warnings
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

from robolink import logging
from robolink.grading.child import Watchdog
from robolink.grading.mistakes import Mistake
from robolink.learn.checking import check
from robolink.learn.exercise import Exercise, chosen, read_course
from robolink.learn.lines import reported
from robolink.learn.report import Report
from robolink.learn.trial import Trial

SOLUTIONS = Path(__file__).parents[1] / "learn" / "solutions"


def shortened(exercise: Exercise) -> Iterator[tuple[str, str]]:
    """Yield each line of a solution, and the program without it."""
    lines = (SOLUTIONS / exercise.file).read_text(encoding="utf-8").splitlines(keepends=True)
    for number, line in enumerate(lines):
        if line.strip():
            yield f"{exercise.file}:{number + 1}: {line.strip()}", "".join(lines[:number] + lines[number + 1 :])


def tried(exercise: Exercise, text: str, folder: Path) -> Report:
    """Check a program; one that never ends is interrupted."""
    file = folder / exercise.file
    file.write_text(text, encoding="utf-8")
    watchdogs: list[Watchdog] = []

    def stuck(mistake: Mistake) -> None:
        import _thread

        _thread.interrupt_main()

    def begun(trial: Trial) -> None:
        watchdogs.append(Watchdog(trial, stuck))
        watchdogs[0].start()

    with contextlib.redirect_stdout(io.StringIO()):
        report = check(exercise, file, begun=begun)
    watchdogs[0].stop()
    return report


def outcome(exercise: Exercise, report: Report) -> str:
    """Return a word for what came of it; 'fault' if the check is to blame."""
    text = "\n".join(reported(exercise, report, "en"))
    if report.mistake is None:
        return "passed" if report.passed else "told"
    if "KeyboardInterrupt" in report.mistake.text:
        return "stuck"
    at_fault = report.mistake.kind in ("check", "elsewhere") or "Traceback" in text
    return "fault" if at_fault else report.mistake.kind


def main(names: list[str]) -> int:
    """Try all, and print what each came to."""
    warnings.simplefilter("ignore")
    logging.set_console_handler(None)
    course = read_course()
    counts: Counter[str] = Counter()
    with tempfile.TemporaryDirectory() as folder:
        for exercise in [chosen(course, name) for name in names] or course:
            for line, text in shortened(exercise):
                report = tried(exercise, text, Path(folder))
                word = outcome(exercise, report)
                counts[word] += 1
                if word == "fault":
                    print(f"{line}\n    {report.mistake}", flush=True)  # noqa: T201
    print(f"{counts.total()} programs: " + ", ".join(f"{count} {word}" for word, count in counts.most_common()))  # noqa: T201
    return 1 if counts["fault"] else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
