"""Checks in processes of their own: whatever a student's file does, one gets a report, and nothing else is harmed."""

from __future__ import annotations

import os
import re
import subprocess
import sys
import textwrap
import threading
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from robolink.cli.shared.output import say
from robolink.grading.mistakes import Mistake
from robolink.grading.process import MOST_PRINTED, SETTINGS, TRACE, why_no_answer
from robolink.learn.checking import LONGEST, check_apart
from robolink.learn.exercise import Exercise, chosen, read_course
from robolink.learn.lines import reported
from robolink.learn.report import Report
from robolink.supervisor.processes.guardian import is_alive

HELLO = chosen(read_course(), "hello")
SOLUTION = (Path(__file__).parent / "solutions" / "02_hello.py").read_text(encoding="utf-8")

pytestmark = pytest.mark.processes


def tried(text: str, folder: Path, exercise: Exercise = HELLO, longest: float = 60.0) -> Report:
    file = folder / exercise.file
    file.write_text(text, encoding="utf-8")
    return check_apart(exercise, file, "en", longest=longest)


def wait_until(is_so: Callable[[], bool]) -> None:
    deadline = time.monotonic() + 30.0
    while not is_so():
        assert time.monotonic() < deadline
        time.sleep(0.02)


@pytest.mark.skipif(sys.platform != "linux", reason="orphans are adopted on Linux")
@pytest.mark.parametrize("ending", ["rclpy.spin(node)", "os._exit(0)", "while True: pass"])
def test_who_has_left_session_parents_and_environment_is_ended_too(ending: str, tmp_path: Path) -> None:
    leave = """
    import os
    if os.fork() == 0:
        os.setsid()
        left = os.fork()
        if left == 0:
            os.execve("/bin/sleep", ["sleep", "600"], {})
        os.write(1, f"left {left} behind\\n".encode())
        os._exit(0)
    os.wait()
    """
    text = SOLUTION.replace("rclpy.spin(node)", textwrap.indent(textwrap.dedent(leave), "    ") + f"    {ending}")
    report = tried(text, tmp_path, longest=6.0)
    left = re.search(r"left (\d+) behind", report.printed)
    assert left is not None, report
    assert not Path("/proc", left[1]).exists()


def test_a_solution_passes_and_what_it_prints_is_shown(tmp_path: Path) -> None:
    report = tried(SOLUTION.replace("rclpy.spin(node)", "print('on my way')\n    rclpy.spin(node)"), tmp_path)
    assert report.passed
    assert "on my way" in report.printed
    assert "[INFO] first_node: hello" in report.printed
    assert [each.name for each in tmp_path.iterdir()] == ["02_hello.py"], "no __pycache__ beside it"
    lines = list(reported(HELLO, report, "en"))
    assert lines[0] == "it printed:"
    assert lines[-1].startswith("02_hello.py is done")


def test_an_exception_in_a_callback_is_told_once(tmp_path: Path) -> None:
    timer = "self.create_timer(0.1, lambda: 1 // 0)"
    report = tried(SOLUTION.replace('self.get_logger().info("hello")', timer), tmp_path)
    assert report.mistake is not None
    assert report.mistake.text.startswith("ZeroDivisionError")
    assert report.printed == ""


def test_an_endless_loop_is_found_with_its_line(tmp_path: Path) -> None:
    report = tried(SOLUTION.replace("    rclpy.spin(node)", "    while True:\n        pass"), tmp_path)
    assert report.mistake is not None
    assert report.mistake.kind == "stuck"
    assert report.mistake.code.strip() in ("while True:", "pass")
    assert any("is there a loop that never ends" in each for each in reported(HELLO, report, "en"))


@pytest.mark.parametrize(
    "ending", ["import os; os._exit(0)", "import os, signal; os.kill(os.getpid(), signal.SIGKILL)"]
)
def test_a_file_that_ends_the_process_is_told(ending: str, tmp_path: Path) -> None:
    if sys.platform == "win32" and "SIGKILL" in ending:
        pytest.skip("Windows has no SIGKILL")
    report = tried(SOLUTION.replace("    rclpy.init()", f"    {ending}"), tmp_path)
    assert report.mistake is not None
    assert report.mistake.kind == "ended all"


def test_a_traceback_of_its_own_code_alone_is_printed_and_only_if_the_report_does_not_tell_it(tmp_path: Path) -> None:
    service, action = chosen(read_course(), "service"), chosen(read_course(), "action")
    solutions = Path(__file__).parent / "solutions"
    text = (solutions / service.file).read_text(encoding="utf-8")
    assert (
        tried(text.replace("return response", "return None"), tmp_path, service).printed.strip()
        == "[INFO] motor: asked for True"
    )
    text = (solutions / action.file).read_text(encoding="utf-8")
    printed = tried(text.replace("feedback.sequence", "feedback.numbers"), tmp_path, action).printed
    assert "feedback.numbers = numbers" in printed
    assert "site-packages" not in printed
    assert printed.count("  File ") == 1


def test_what_does_not_even_let_others_run_is_killed(tmp_path: Path) -> None:
    hangs = "import re\nre.match(r'(a+)+$', 'a' * 60 + 'b')\n"  # in C, which keeps all other threads from running
    begin = time.monotonic()
    report = tried(hangs + SOLUTION, tmp_path, longest=3.0)
    assert report.mistake == Mistake("stuck somewhere")
    assert time.monotonic() - begin < 20.0


def test_a_program_that_never_ends_is_ended_by_whoever_wants_its_report_no_more(tmp_path: Path) -> None:
    file = tmp_path / HELLO.file
    file.write_text(f"open({str(tmp_path / 'begun')!r}, 'w').close()\nwhile True:\n    pass\n", encoding="utf-8")
    stop = threading.Event()
    reports: list[Report] = []
    thread = threading.Thread(target=lambda: reports.append(check_apart(HELLO, file, "en", stop=stop)))
    thread.start()
    while not (tmp_path / "begun").exists():
        time.sleep(0.01)
    stop.set()
    begin = time.monotonic()
    thread.join()
    assert time.monotonic() - begin < LONGEST / 2, "the watchdog would take longer"
    assert not reports[0].passed


@pytest.mark.skipif(sys.platform != "linux", reason="other systems have no such limit")
def test_a_program_that_wants_all_memory_is_told(tmp_path: Path) -> None:
    report = tried(SOLUTION.replace("    rclpy.spin(node)", "    text = 'a' * 10**10"), tmp_path)
    assert report.mistake is not None
    assert report.mistake.kind == "exception"
    assert report.mistake.text == "MemoryError"
    assert report.mistake.code == "    text = 'a' * 10**10"


def test_where_code_stands_that_lets_no_other_thread_run(tmp_path: Path) -> None:
    file, answer = tmp_path / HELLO.file, tmp_path / "answer.json"
    file.write_text(
        SOLUTION.replace("    rclpy.spin(node)", "    print('before')\n    number = 9**9**9"), encoding="utf-8"
    )
    program = (
        "import sys; from pathlib import Path; from robolink.grading import child; from robolink.learn import checking;"
        "child.FROZEN = 3;"
        " checking.serve(*map(Path, sys.argv[1:]), 'en')"
    )
    words = [sys.executable, "-c", program, str(HELLO.folder), str(file), str(answer)]
    done = subprocess.run(words, capture_output=True, check=False, timeout=60.0, env={**os.environ, **SETTINGS})
    assert done.returncode == 1
    assert b"before" in done.stdout
    assert not answer.exists()
    mistake = why_no_answer(tmp_path / TRACE, file, in_time=True)
    assert (mistake.kind, mistake.code) == ("stuck", "    number = 9**9**9")


@pytest.mark.skipif(sys.platform == "win32", reason="it has no FIFOs")
def test_a_fifo_in_the_place_of_the_answer_blocks_nobody(tmp_path: Path) -> None:
    blocks = "    import os, sys\n    os.mkfifo(sys.orig_argv[-1])\n    os._exit(0)\n"
    assert tried(SOLUTION.replace("    rclpy.spin(node)", blocks), tmp_path).mistake == Mistake("ended all")


@pytest.mark.skipif(sys.platform != "linux", reason="other systems do not show environments")
def test_nothing_is_left_of_what_a_program_starts(tmp_path: Path) -> None:
    starts = (
        "    import subprocess, tempfile\n    print(tempfile.mkdtemp())\n"
        "    print(subprocess.Popen(['sleep', '60'], start_new_session=True).pid)\n"
    )
    report = tried(SOLUTION.replace("    rclpy.spin(node)", starts + "    rclpy.spin(node)"), tmp_path)
    assert report.passed
    number = next(int(each) for each in report.printed.split() if each.isdecimal())
    assert not is_alive(number)
    (made,) = (each for each in report.printed.split() if Path(each).is_absolute())
    assert not Path(made).exists()


@pytest.mark.skipif(sys.platform == "win32", reason="its processes end otherwise")
def test_nothing_is_left_when_the_command_is_killed(tmp_path: Path) -> None:
    file, note = tmp_path / HELLO.file, tmp_path / "note"
    waits = (
        "    import os, subprocess\n    open({!r}, 'w').write(str(os.getpid()))\n    subprocess.run(['sleep', '60'])\n"
    )
    file.write_text(SOLUTION.replace("    rclpy.spin(node)", waits.format(str(note))), encoding="utf-8")
    program = (
        "import sys; from pathlib import Path; from robolink.learn import checking, exercise;"
        " checking.check_apart(exercise.read_exercise(Path(sys.argv[1])), Path(sys.argv[2]), 'en')"
    )
    with subprocess.Popen([sys.executable, "-c", program, str(HELLO.folder), str(file)]) as process:
        wait_until(lambda: note.exists() and note.read_text() != "")
        process.kill()
    wait_until(lambda: not is_alive(int(note.read_text())))


def test_a_flood_of_words_is_cut(tmp_path: Path) -> None:
    flood = SOLUTION.replace("    rclpy.spin(node)", "    print('x' * 5_000_000)\n    rclpy.spin(node)")
    report = tried(flood, tmp_path)
    assert report.passed
    assert len(report.printed) <= MOST_PRINTED


def test_it_works_in_a_folder_of_its_own(tmp_path: Path) -> None:
    (tmp_path / "precious.txt").write_text("mine")
    clears = "import os, shutil\nshutil.rmtree(os.getcwd())\n"
    tried(clears + SOLUTION, tmp_path)
    assert (tmp_path / "precious.txt").read_text() == "mine"


def test_what_a_program_prints_is_fit_for_a_terminal(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    text = SOLUTION.replace("    rclpy.spin(node)", "    print('evil\\x1b[2J')\n    rclpy.spin(node)")
    report = tried(text, tmp_path)
    assert "\x1b[2J" in report.printed
    for line in reported(HELLO, report, "en"):
        say(line)
    assert "\x1b" not in capsys.readouterr().out
