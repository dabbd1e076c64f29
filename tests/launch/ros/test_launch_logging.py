"""launch.logging: loggers of a launch, their formats, files and folders; and signals on a loop."""

from __future__ import annotations

import asyncio
import logging
import os
import signal
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from robolink.launch.ros.launch import log_handlers
from robolink.launch.ros.launch import logging as launch_logging
from robolink.launch.ros.launch.logging import LogConfigError, get_logger, get_output_loggers, launch_config
from robolink.launch.ros.launch.signals import AsyncSafeSignalManager


@pytest.fixture(autouse=True)
def logs(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Iterator[Path]:
    for name in ("OVERRIDE_LAUNCH_SCREEN_FORMAT", "OVERRIDE_LAUNCH_LOG_FORMAT", "ROS_HOME"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("ROS_LOG_DIR", str(tmp_path))
    launch_logging.reset()
    yield tmp_path
    launch_logging.reset()


def test_each_run_has_a_folder_and_latest_leads_to_it(logs: Path) -> None:
    assert not list(logs.iterdir())  # nothing before it is asked for
    folder = Path(launch_config.log_dir)
    assert folder.parent == logs
    if sys.platform != "win32":
        assert (logs / "latest").resolve() == folder.resolve()
    assert Path(launch_config.log_dir) == folder


@pytest.mark.skipif(sys.platform == "win32", reason="links need rights there")
def test_something_else_called_latest_is_left_alone(logs: Path) -> None:
    (logs / "latest").mkdir()
    with pytest.warns(UserWarning, match="something else has that name"):
        assert Path(launch_config.log_dir).is_dir()
    assert (logs / "latest").is_dir()


@pytest.mark.parametrize(
    ("output", "screen", "files"),
    [
        ("screen", ["out", "err"], {}),
        ("log", ["err"], {"launch.log": ["out", "err"]}),
        ("both", ["out", "err"], {"launch.log": ["out", "err"]}),
        ("own_log", [], {"it-stdout.log": ["out"], "it-stderr.log": ["err"], "it.log": ["out", "err"]}),
        ({"stdout": "screen", "stderr": {"own_log"}}, ["out"], {"it-stderr.log": ["err"]}),
    ],
)
def test_output_goes_where_it_is_wanted(
    output: object, screen: list[str], files: dict[str, list[str]], capsys: pytest.CaptureFixture[str]
) -> None:
    out, err = get_output_loggers("it", output)
    out.info("out")
    err.info("err")
    assert capsys.readouterr().out.splitlines() == screen
    for name, lines in files.items():
        text = Path(launch_config.get_log_file_path(name)).read_text(encoding="utf-8")
        assert [each.split()[-1] for each in text.splitlines()] == lines
    assert set(launch_config.file_handlers) == set(files)


@pytest.mark.parametrize("output", ["nowhere", {"out": "log"}, {"stdout": {"paper"}}, 5])
def test_wrong_output_is_refused(output: object) -> None:
    with pytest.raises(LogConfigError, match=r"output|writes"):
        get_output_loggers("it", output)


def test_formats_are_named_given_or_of_the_environment(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    get_logger("a").info("b")
    launch_config.set_screen_format("{name}: {msg}")
    get_logger("a").info("b")
    monkeypatch.setenv("OVERRIDE_LAUNCH_SCREEN_FORMAT", "{msg}\\t{name}")
    launch_config.set_screen_format("default")
    get_logger("a").info("b")
    assert capsys.readouterr().out.splitlines() == ["[INFO] [a]: b", "a: b", "b\ta"]
    with pytest.raises(LogConfigError, match="has a style of its own"):
        launch_config.set_log_format("default", log_style="%")
    with pytest.raises(LogConfigError, match="not there"):
        launch_config.log_dir = "no/such/folder"


def test_handlers_are_pythons_with_a_format_for_each_logger(capsys: pytest.CaptureFixture[str]) -> None:
    handler: Any = log_handlers.StreamHandler(sys.stdout)
    assert issubclass(type(handler), logging.StreamHandler)
    handler.setFormatterFor("one", logging.Formatter("1 %(message)s"))
    for name in ("one", "two"):
        handler.handle(logging.LogRecord(name, logging.INFO, "", 0, "x", None, None))
    handler.unsetFormatterFor("one")
    handler.handle(logging.LogRecord("one", logging.INFO, "", 0, "x", None, None))
    assert capsys.readouterr().out.splitlines() == ["1 x", "x", "x"]
    with pytest.raises(AttributeError, match="no handler 'Formatter'"):
        _ = log_handlers.Formatter


@pytest.mark.skipif(sys.platform == "win32", reason="there is no SIGUSR1")
def test_signals_are_handled_on_the_loop_while_the_block_runs() -> None:
    usr1 = signal.Signals["SIGUSR1"]

    async def main() -> int:
        seen: asyncio.Queue[int] = asyncio.Queue()
        manager = AsyncSafeSignalManager(asyncio.get_running_loop())
        manager.handle(usr1, seen.put_nowait)
        with manager:
            os.kill(os.getpid(), usr1)
            number = await asyncio.wait_for(seen.get(), 10.0)
            assert manager.handle(usr1, None) == seen.put_nowait
            assert signal.getsignal(usr1) is signal.SIG_IGN
        return number

    signal.signal(usr1, signal.SIG_IGN)
    try:
        assert asyncio.run(main()) == usr1
    finally:
        signal.signal(usr1, signal.SIG_DFL)
