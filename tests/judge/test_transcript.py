"""Programs that hang, crash or flood do not hold up whoever runs them; what they printed is kept."""

from __future__ import annotations

import sys
import time
from pathlib import Path

import pytest

from tests.judge.transcript import header, transcript

pytestmark = [
    pytest.mark.processes,
    pytest.mark.skipif(sys.platform != "linux", reason="ends programs as the judge does, by groups of processes"),
]


def _transcript(folder: Path, text: str, limit: float = 20.0) -> str:
    program = folder / "planted.py"
    program.write_text(text, encoding="utf-8")
    return transcript(program, [sys.executable], 1, limit=limit)


def test_streams_and_exit_code(tmp_path: Path) -> None:
    seen = _transcript(tmp_path, "import sys\nprint('out')\nprint('err', file=sys.stderr)\nsys.exit(3)")
    assert seen == "--- stdout\nout\n--- stderr\nerr\n--- exit 3\n"


def test_a_traceback_is_its_last_line(tmp_path: Path) -> None:
    assert _transcript(tmp_path, "int('x')").endswith(
        "Traceback ...\nValueError: invalid literal for int() with base 10: 'x'\n--- exit 1\n"
    )


def test_a_program_that_hangs_is_killed(tmp_path: Path) -> None:
    text = "import signal, time\nsignal.signal(signal.SIGTERM, signal.SIG_IGN)\nprint('begun')\ntime.sleep(60)"
    begin = time.monotonic()
    assert _transcript(tmp_path, text, limit=1.0) == "--- stdout\nbegun\n--- stderr\n--- exit hangs\n"
    assert time.monotonic() - begin < 15.0


def test_a_child_that_keeps_the_streams_does_not_hold_it_up(tmp_path: Path) -> None:
    text = (
        "import subprocess, sys\nsubprocess.Popen([sys.executable, '-c', 'import time; time.sleep(60)'])\nprint('end')"
    )
    begin = time.monotonic()
    assert _transcript(tmp_path, text).endswith("--- exit 0\n")
    assert time.monotonic() - begin < 15.0


@pytest.mark.parametrize("line", ["x", "x\\n"])
def test_a_program_that_floods_is_killed(tmp_path: Path, line: str) -> None:
    seen = _transcript(tmp_path, f"import sys\nwhile True: sys.stdout.write('{line}' * 1000)")
    assert seen.endswith("--- exit floods\n")


def test_a_program_that_crashes_says_by_which_signal(tmp_path: Path) -> None:
    assert _transcript(tmp_path, "import os\nos.abort()").endswith("--- exit -6\n")


def test_a_signal_comes_when_the_program_is_ready(tmp_path: Path) -> None:
    text = (
        "# signal: INT 0.05\nimport time\n"
        "print('READY', flush=True)\ntry: time.sleep(20)\nexcept KeyboardInterrupt: print('interrupted')"
    )
    assert _transcript(tmp_path, text) == "--- stdout\nREADY\ninterrupted\n--- stderr\n--- exit 0\n"


def test_the_first_lines_say_how_a_program_is_run(tmp_path: Path) -> None:
    program = tmp_path / "program.py"
    program.write_text("# args: -p 'a b' $HERE/x\n# env: A=1 \"B=2 3\"\n# signal: INT 0.5\nprint()\n# args: no\n")
    found = header(program)
    assert (found.args, found.env, found.signals) == (
        ["-p", "a b", f"{tmp_path}/x"],
        {"A": "1", "B": "2 3"},
        [("INT", 0.5)],
    )
