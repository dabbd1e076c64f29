"""What is otherwise on Windows and macOS, as far as one system can show it of another."""

from __future__ import annotations

import ast
import ctypes
import io
import json
import os
import queue
import re
import shutil
import signal
import subprocess
import sys
import threading
from collections.abc import Callable
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any

import pytest

from robolink import signals
from robolink.cli.main import main
from robolink.cli.shared.commands import NOUNS
from robolink.cli.tf import tree
from robolink.control.keyboard import WindowsKeyboard
from robolink.extensions.optional import is_here
from robolink.launch import lookup
from robolink.running import timebase
from robolink.supervisor.policy import Step
from robolink.supervisor.processes import affinity, process
from robolink.supervisor.processes.process import Child
from robolink.supervisor.reporting import logs
from robolink.system import clocks, files, terminal
from robolink.system.waits import A_WHILE
from robolink.transport import network
from tests.support.commands import PATIENCE
from tests.support.nodefiles import load_node_file

ROOT = Path(__file__).parents[2]
teleop = load_node_file("teleop")


@pytest.fixture
def windows(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "platform", "win32")


# Letters


@pytest.mark.parametrize("command", [name for name, entry in NOUNS.items() if is_here(entry.module)])
def test_help_is_for_every_terminal(command: str, capsys: pytest.CaptureFixture[str]) -> None:
    def check(words: list[str]) -> str:
        assert main([*words, "--help"]) == 0
        shown = capsys.readouterr().out
        assert shown.isascii()
        return shown

    verbs = re.findall(r"^  ([a-z_]+)", check([command]).partition("Commands:\n")[2], re.MULTILINE)
    for each in verbs:
        check([command, each])


def said(*command: str, cwd: Path, **environ: str) -> tuple[int, bytes, bytes]:
    """Run a program; its exit code and what it wrote."""
    every = {**os.environ, "ROBOLINK_NETWORK": "off", **environ}
    done = subprocess.run([sys.executable, *command], cwd=cwd, env=every, capture_output=True, timeout=PATIENCE)
    return done.returncode, done.stdout, done.stderr


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A workspace whose every file has letters that are not in ASCII."""
    files = {
        "nodes/zürich.py": '"""Fährt → ab."""\n\nfrom robolink import Node\n\n\nclass Zürich(Node):\n'
        '    def __init__(self):\n        super().__init__("zuerich")\n'
        '        self.get_logger().info(self.declare_parameter("grüße", "").value)\n',
        "configs/straße.yaml": "arguments: {gruß: 'schöne → Grüße'}\n"
        "nodes: [{node: zürich, parameters: {grüße: '{gruß}'}, on_exit: ignore}]\n",
        "interfaces/zoo_msgs/msg/Owl.msg": "# Eule → né\nint32 x\n",
    }
    for name, text in files.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text, encoding="utf-8")
    return tmp_path


@pytest.mark.processes
@pytest.mark.parametrize("encoding", ["ascii", "cp1252", "cp850"])
@pytest.mark.parametrize(
    "words",
    [
        ["launch", "./configs/straße.yaml", "--show-args"],
        ["launch", "./configs/straße.yaml", "--graph"],
        ["run", "--list"],
        ["interface", "show", "zoo_msgs/msg/Owl"],
    ],
)
def test_what_a_command_shows_fits_an_output_of_any_encoding(folder: Path, words: list[str], encoding: str) -> None:
    code, out, err = said("-m", "robolink", *words, cwd=folder, PYTHONIOENCODING=encoding, PYTHONUTF8="1")
    assert (code, err) == (0, b"")
    assert out.decode("utf-8" if encoding == "ascii" else encoding)  # click takes ASCII for UTF-8


@pytest.mark.processes
@pytest.mark.skipif(sys.platform != "linux", reason="sets a locale without letters, as POSIX has it")
def test_files_are_utf_8_whatever_the_locale_is(folder: Path) -> None:
    """As on Windows, where Python would read and write them in the country's own letters; each such place warns."""
    for name, plain in (("configs/straße.yaml", "configs/a.yaml"), ("nodes/zürich.py", "nodes/b.py")):
        (folder / name).rename(folder / plain)
    text = (folder / "configs/a.yaml").read_text(encoding="utf-8")
    (folder / "configs/a.yaml").write_text(text.replace("zürich", "b"), encoding="utf-8")
    bare = {"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0", "PYTHONWARNDEFAULTENCODING": "1"}
    hashes = []
    for environ in (bare, {}):
        command = ["-W", "error::EncodingWarning", "-m", "robolink", "simulate", "./configs/a.yaml", "--duration", "1"]
        code, out, err = said(*command, "--json", cwd=folder, **environ)
        assert (code, err) == (0, b"")
        hashes.append(json.loads(out)["hash"])
    assert hashes[0] == hashes[1]


@pytest.mark.usefixtures("windows")
def test_what_is_launched_prints_utf_8_on_windows(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("PYTHONIOENCODING", raising=False)
    assert process._plain_output()["PYTHONIOENCODING"] == "utf-8"
    monkeypatch.setenv("PYTHONIOENCODING", "cp437")
    assert process._plain_output()["PYTHONIOENCODING"] == "cp437"


def test_a_tree_is_drawn_with_what_the_output_has(monkeypatch: pytest.MonkeyPatch) -> None:
    drawn = "│  └─ né"
    for encoding, expected in (("utf-8", drawn), ("cp850", drawn), ("cp1252", "|  `- né"), ("ascii", "|  `- né")):
        monkeypatch.setattr(sys, "stdout", io.TextIOWrapper(io.BytesIO(), encoding=encoding))
        assert tree._drawable(drawn) == expected


@pytest.mark.usefixtures("windows")
def test_a_console_is_switched_to_colours_once(monkeypatch: pytest.MonkeyPatch) -> None:
    calls: list[str] = []

    def system(command: str) -> int:
        calls.append(command)
        return 0

    monkeypatch.setattr(os, "system", system)
    terminal._escapes_switched_on.cache_clear()
    assert all(terminal.knows_colours() for _ in range(3))
    terminal._escapes_switched_on.cache_clear()
    assert calls == [""]


# Keys


class WindowsConsole(ModuleType):
    """msvcrt as it is: of an arrow's two characters the second waits in a buffer, and `kbhit` only knows `getch`'s."""

    def __init__(self, typed: list[bytes]) -> None:
        super().__init__("msvcrt")
        self.typed, self.narrow, self.wide = typed, b"", ""

    def kbhit(self) -> bool:
        return bool(self.narrow or self.typed)

    def getch(self) -> bytes:
        key, self.narrow = (self.narrow, b"") if self.narrow else (self.typed.pop(0), b"")
        key, self.narrow = key[:1], key[1:]
        return key

    def getwch(self) -> str:
        key, self.wide = (self.wide, "") if self.wide else (self.typed.pop(0).decode("latin-1"), "")
        key, self.wide = key[:1], key[1:]
        return key


@pytest.mark.usefixtures("windows")
def test_an_arrow_of_windows_is_read_whole(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "msvcrt", WindowsConsole([b"\xe0H", b"w", b"\x85", b"\x00K"]))
    keyboard = WindowsKeyboard()
    assert [each for each in teleop.keys(keyboard.read()) if each in teleop.DIRECTIONS] == ["up", "w", "left"]
    assert keyboard.read() == ""


# Time


def test_windows_is_asked_for_its_finest_clock(windows: None, monkeypatch: pytest.MonkeyPatch) -> None:
    def tell(place: Any) -> None:
        place._obj.value = 116_444_736_000_000_000 + 15  # tenths of a microsecond since 1601

    asked: list[int] = []
    libraries = {
        "kernel32": SimpleNamespace(GetSystemTimePreciseAsFileTime=tell),
        "winmm": SimpleNamespace(timeBeginPeriod=asked.append),
    }
    monkeypatch.setattr(ctypes, "WinDLL", libraries.__getitem__, raising=False)
    monkeypatch.setattr(sys, "version_info", (3, 12))
    assert clocks._finest_now()() == 1500
    clocks.make_waits_exact.cache_clear()
    timebase.SystemTime()
    timebase.SystemTime()
    clocks.make_waits_exact.cache_clear()
    assert asked == [1]


def test_a_wait_for_an_answer_is_none_that_ctrl_c_must_break(monkeypatch: pytest.MonkeyPatch) -> None:
    """On Windows it could not: each wait of a long one is short."""
    waits: list[float] = []

    class Slow:
        def get_nowait(self) -> int:
            raise queue.Empty

        def get(self, timeout: float) -> int:
            waits.append(timeout)
            if len(waits) < 4:
                raise queue.Empty
            return 7

    time, source = timebase.SystemTime(), Slow()
    assert time.take(source, None) == 7  # type: ignore[arg-type]
    waits.clear()
    assert time.take(source, time.steady() + 3600 * 10**9) == 7  # type: ignore[arg-type]
    assert waits == [A_WHILE] * 4


# Processes


@pytest.mark.usefixtures("windows")
def test_a_process_that_no_ctrl_break_reaches_is_no_error(monkeypatch: pytest.MonkeyPatch) -> None:
    class Ended:
        terminated = False

        def send_signal(self, number: int) -> None:
            raise OSError(87, "The parameter is incorrect")

        def terminate(self) -> None:
            self.terminated = True

    monkeypatch.setattr(signal, "CTRL_BREAK_EVENT", 1, raising=False)
    child = object.__new__(Child)
    ended = Ended()
    monkeypatch.setattr(child, "_popen", ended, raising=False)
    monkeypatch.setattr(child, "_has_ended", False, raising=False)
    child.ask(Step.INTERRUPT)
    assert not ended.terminated
    child.ask(Step.TERMINATE)
    assert ended.terminated


def test_ctrl_break_ends_a_program_as_ctrl_c_does(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "excepthook", sys.excepthook)
    monkeypatch.setattr(threading, "excepthook", threading.excepthook)
    monkeypatch.setattr(signals, "_quiet", False)
    signals._end_quietly()
    for received, code in ((21, 130), (signal.SIGINT, 130), (signal.SIGTERM, 143)):  # 21: SIGBREAK
        monkeypatch.setattr(signals, "_received", received)
        with pytest.raises(SystemExit) as caught:
            sys.excepthook(KeyboardInterrupt, KeyboardInterrupt(), None)
        assert caught.value.code == code


@pytest.mark.processes
def test_the_python_that_a_virtual_environment_starts_on_windows_is_kept_on_its_core_too() -> None:
    if sys.platform == "darwin":
        pytest.skip("macOS keeps no process on a core")
    import psutil

    inner = "import sys; print(1, flush=True); sys.stdin.read()"
    outer = f"import subprocess, sys; sys.exit(subprocess.call([sys.executable, '-c', {inner!r}]))"
    pipe = subprocess.PIPE
    with subprocess.Popen([sys.executable, "-c", outer], stdin=pipe, stdout=pipe) as started:
        assert started.stdout is not None
        assert started.stdout.readline().strip() == b"1"
        core = affinity.usable_cores()[-1]
        assert affinity._set_on_windows(started.pid, [core]) == ""
        [child] = psutil.Process(started.pid).children()
        assert child.cpu_affinity() == [core]
        started.communicate()


def test_windows_is_given_a_program_by_its_path(windows: None, monkeypatch: pytest.MonkeyPatch) -> None:
    """It would not find a `.bat` by its name; and what it calls python3 may be a way to its shop."""
    places = {
        "make": "C:/gnu/make.BAT",
        "python3": "C:/Users/a/WindowsApps/python3.EXE",
        "python": "C:/Python/python.EXE",
    }
    monkeypatch.setattr(shutil, "which", lambda name, path=None: places.get(name))
    assert lookup.command_of(["make", "all"], None) == ["C:/gnu/make.BAT", "all"]
    assert lookup.command_of(["python", "-V"], None) == ["C:/Python/python.EXE", "-V"]
    assert lookup.command_of(["python3", "-V"], None) == [sys.executable, "-V"]
    assert lookup.command_of(["gone"], None) is None
    assert "what runs it, as python" in lookup.why_no_command(str(ROOT / "tools/make.py"))


# Files


def replaced_unless(is_refused: Callable[[Path], bool]) -> Callable[[Path, Path], Path]:
    really = Path.replace

    def replace(path: Path, target: Path) -> Path:
        if is_refused(target):
            raise PermissionError(13, "Access is denied")
        return really(path, target)

    return replace


@pytest.mark.usefixtures("windows")
@pytest.mark.parametrize("times", [3, 10**6])
def test_a_file_that_somebody_reads_is_replaced_a_moment_later(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, times: int
) -> None:
    """As an editor or a virus scanner does."""
    pauses: list[float] = []
    file = tmp_path / "progress.json"
    file.write_bytes(b"old")
    monkeypatch.setattr(Path, "replace", replaced_unless(lambda target: len(pauses) < times))
    monkeypatch.setattr("robolink.system.files.time.sleep", pauses.append)
    if times == 3:
        files.write_whole(file, b"new")
    else:
        with pytest.raises(PermissionError, match=r"progress\.json"):
            files.write_whole(file, b"new")
    assert (file.read_bytes(), [*tmp_path.iterdir()]) == (b"new" if times == 3 else b"old", [file])
    assert sum(pauses) <= 0.6


def test_no_temporary_folder_fails_since_a_file_in_it_is_open() -> None:
    """Windows removes no open file; what is left there is the system's to clear away."""
    package = Path(clocks.__file__).parents[1]
    calls = [
        f"{file.relative_to(package)}:{node.lineno}"
        for file in package.rglob("*.py")
        if "TemporaryDirectory(" in (text := file.read_text(encoding="utf-8"))
        for node in ast.walk(ast.parse(text))
        if isinstance(node, ast.Call) and ast.unparse(node.func).endswith("TemporaryDirectory")
        if "ignore_cleanup_errors" not in [each.arg for each in node.keywords]
    ]
    assert calls == []


@pytest.mark.usefixtures("windows")
def test_latest_is_a_folder_for_windows_and_leads_to_the_newest_all_the_same(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(Path, "replace", replaced_unless(lambda target: target.is_symlink()))
    for name in ("first", "second"):
        (tmp_path / name).mkdir()
        logs._point_to(tmp_path / name)
        assert (tmp_path / "latest").resolve() == (tmp_path / name).resolve()
    assert sorted(each.name for each in tmp_path.iterdir()) == ["first", "latest", "second"]


@pytest.mark.usefixtures("windows")
def test_a_log_that_somebody_reads_goes_on_when_it_is_full(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Path, "replace", replaced_unless(lambda target: True))
    monkeypatch.setattr(logs, "LARGEST", 8)
    file = logs._File(tmp_path / "a.log")
    for line in (b"the first\n", b"the second\n"):
        file.write(line)
    file.close()
    assert (tmp_path / "a.log").read_bytes() == b"the second\n"


@pytest.mark.parametrize(
    ("value", "file"),
    [
        ("file:///C:/a b/z.json5", "C:/a b/z.json5"),
        ("file:///etc/z.json5", "/etc/z.json5"),
        ("z.json5", "z.json5"),
        ("C:/z.json5", "C:/z.json5"),
    ],
)
def test_a_file_is_named_by_its_path_or_its_address(value: str, file: str) -> None:
    assert network.file_of(value) == Path(file)
