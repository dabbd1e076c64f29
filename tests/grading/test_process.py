"""A student's program in a process of its own: what ends it, who has started what, and whose answer is taken."""

from __future__ import annotations

import subprocess
import sys
import time
from pathlib import Path

import pytest

from robolink.grading import process
from robolink.grading.child import Watchdog, memory_of_this_process
from robolink.grading.languages import MISTAKES, STUDENT_FILE, default_language, language_here, language_of, text_of
from robolink.grading.mistakes import Mistake
from robolink.grading.process import TRACE, kill_descendants, why_no_answer


def test_a_process_that_is_killed_from_outside_is_stuck_somewhere(tmp_path: Path) -> None:
    assert why_no_answer(tmp_path / TRACE, tmp_path, in_time=False) == Mistake("stuck somewhere")
    assert why_no_answer(tmp_path / TRACE, tmp_path, in_time=True) == Mistake("ended all")


def test_the_line_is_found_in_folders_of_any_name(tmp_path: Path) -> None:
    file = tmp_path / "Área" / "ação" / "hello.py"
    file.parent.mkdir(parents=True)
    file.write_text("one\ntwo\n", encoding="utf-8")
    with (tmp_path / TRACE).open("w", encoding="ascii") as trace:
        code = compile("import faulthandler\nfaulthandler.dump_traceback(trace)", str(file), "exec")
        exec(code, {"trace": trace})
    assert why_no_answer(tmp_path / TRACE, file, in_time=True) == Mistake("stuck", "", 2, "two")


@pytest.mark.processes
def test_what_a_program_has_started_is_found_by_its_parents(tmp_path: Path) -> None:
    """Where no session and no mark leads to it, as on Windows."""
    import psutil

    inner = "import time; print(1, flush=True); time.sleep(600)"
    middle = f"import subprocess, sys; subprocess.run([sys.executable, '-c', {inner!r}])"
    since = time.time() - 5.0  # Linux knows the beginning of a process less exactly
    with subprocess.Popen([sys.executable, "-c", middle], stdout=subprocess.PIPE) as started:
        assert started.stdout is not None
        assert started.stdout.readline().strip() == b"1"
        [child] = psutil.Process(started.pid).children()
        kill_descendants(started.pid, time.time() + 3600.0)
        assert child.is_running()
        kill_descendants(started.pid, since)
        assert child.wait(30.0) is not None or not child.is_running()
        started.wait(30.0)


def test_a_program_that_takes_all_memory_ends_where_no_system_limits_it(tmp_path: Path) -> None:
    class Run:
        file = tmp_path / "growing.py"

        def moment(self) -> tuple[float, int]:
            return time.monotonic(), 0

    found: list[Mistake] = []
    sizes = iter([2**20, 3 * 2**30, 5 * 2**30])
    watchdog = Watchdog(Run(), found.append, memory=lambda: next(sizes))
    watchdog.start()
    watchdog.join(30.0)
    assert found == [Mistake("too large", "4 GB")]
    assert "needs more than 4 GB" in text_of(MISTAKES, "en", found[0].kind, text=found[0].text)
    assert 2**20 < memory_of_this_process()() < 4 * 2**30


def test_only_the_holder_of_the_key_signs() -> None:
    key, other = process.new_key(), process.new_key()
    assert process.opened(process.signed(b"{}", key), key) == b"{}"
    for forged in (b"", b"{}", process.signed(b"{}", other), process.signed(b"{}", key)[:-1] + b"]"):
        assert process.opened(forged, key) == b""


@pytest.mark.parametrize(("name", "found"), [("pt_BR.UTF-8", "pt"), ("en_GB", "en"), ("de_DE", None), ("", None)])
def test_languages_of_locales(name: str, found: str | None) -> None:
    assert language_of(name) == found
    assert default_language({"LANG": name}) == (found or "en")


def test_the_locale_s_variables_have_an_order() -> None:
    assert default_language({"LANG": "pt_BR.UTF-8", "LC_ALL": "en_US.UTF-8"}) == "en"
    assert default_language({"LANG": "en_US.UTF-8", "LC_MESSAGES": "pt_BR.UTF-8"}) == "pt"


@pytest.mark.parametrize(
    ("content", "found"), [(b'{"language": "pt"}', "pt"), (b'{"language": "fr"}', "en"), (b"{", "en")]
)
def test_the_language_here_is_that_of_the_student_s_folder(
    content: bytes, found: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("LC_ALL", "en_US.UTF-8")
    (tmp_path / STUDENT_FILE).write_bytes(content)
    (tmp_path / "below").mkdir()
    monkeypatch.chdir(tmp_path / "below")
    assert language_here() == found
