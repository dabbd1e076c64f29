"""Logging of launches (`launch.logging`): loggers with one handler for the terminal and one for the launch's log file.

They are Python's own. The folder of the files is made when the first of these is opened: `$ROS_LOG_DIR`, else
`$ROS_HOME/log`, else `~/.ros/log`, and in it one for each run.
"""

from __future__ import annotations

import datetime
import logging
import os
import socket
import sys
import warnings
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any

from robolink.launch.ros.launch import log_handlers as handlers
from robolink.launch.ros.launch.bases import LaunchError
from robolink.system import clocks

__all__ = [
    "get_logger",
    "get_output_loggers",
    "handlers",
    "launch_config",
    "log_launch_config",
    "reset",
]

_SCREEN = {
    "default": "[{levelname}] [{name}]: {msg}",
    "default_with_timestamp": "{created:.7f} [{levelname}] [{name}]: {msg}",
}
_FILE = {"default": "{created:.7f} [{levelname}] [{name}]: {msg}"}
_SOURCES, _TARGETS = ("stdout", "stderr", "both"), ("screen", "log", "own_log")
_ALIASES: dict[str, dict[str, set[str]]] = {
    "screen": {"both": {"screen"}},
    "log": {"both": {"log"}, "stderr": {"screen"}},
    "both": {"both": {"log", "screen"}},
    "own_log": {"both": {"own_log"}, "stdout": {"own_log"}, "stderr": {"own_log"}},
    "full": {"both": {"screen", "log", "own_log"}, "stdout": {"own_log"}, "stderr": {"own_log"}},
}


class LogConfigError(LaunchError, ValueError):
    """A setting of launch's logging is wrong; the text names it."""


def _get_logging_directory() -> str:
    """Return the folder in which each run has one of its own."""
    folder = os.environ.get("ROS_LOG_DIR") or os.path.join(os.environ.get("ROS_HOME") or "~/.ros", "log")  # noqa: PTH118
    return os.path.normpath(os.path.expanduser(folder))  # noqa: PTH111 - `~nobody` stays as it is


def _make_unique_log_dir(*, base_path: str) -> str:
    """Make a folder for this run, named by time, host and process, and return its path."""
    while True:
        now = datetime.datetime.fromtimestamp(clocks.time_of_day()).astimezone()
        folder = Path(base_path, f"{now:%Y-%m-%d-%H-%M-%S-%f}-{socket.gethostname()}-{os.getpid()}")
        try:
            folder.mkdir(parents=True)
        except FileExistsError:
            continue
        return str(folder)


def _renew_latest_log_dir(*, log_dir: str) -> bool:
    """Let the link `latest` beside a folder lead to it; return False where something else has this name."""
    link = Path(log_dir).parent / "latest"
    if os.path.lexists(link):
        if not link.is_symlink():
            return False
        link.unlink()
    link.symlink_to(log_dir, target_is_directory=True)
    return True


class _Screen:
    """Stream that writes to whatever `sys.stdout` is, in letters that it can have."""

    def write(self, text: str) -> int:
        encoding = getattr(sys.stdout, "encoding", None) or "utf-8"
        return sys.stdout.write(text.encode(encoding, "replace").decode(encoding, "replace"))

    def flush(self) -> None:
        sys.stdout.flush()


class LaunchConfig:
    """Settings of launch's logging: its folder, formats and handlers, one for the screen and one for each file."""

    def __init__(self) -> None:
        self._log_dir: str | None = None
        self.file_handlers: dict[str, Any] = {}
        self.screen_handler: Any = None
        self.screen_formatter: logging.Formatter | None = None
        self.file_formatter: logging.Formatter | None = None
        self._log_handler_factory: Callable[..., Any] | None = None
        self.level = logging.INFO
        self.set_screen_format("default")
        self.set_log_format("default")

    def reset(self) -> None:
        """Set all as it is at first."""
        for each in self.file_handlers.values():
            each.close()
        self.__init__()  # type: ignore[misc]

    @property
    def level(self) -> int:
        """Level from which on loggers log that have none of their own."""
        return logging.root.getEffectiveLevel()

    @level.setter
    def level(self, new_level: int) -> None:
        logging.root.setLevel(new_level)

    @property
    def log_dir(self) -> str:
        """Folder of the log files of this run; it is made when it is first asked for."""
        if self._log_dir is None:
            self._log_dir = _make_unique_log_dir(base_path=_get_logging_directory())
            try:
                reason = "" if _renew_latest_log_dir(log_dir=self._log_dir) else "something else has that name"
            except OSError as error:  # such as on Windows, where not everybody may make links
                reason = str(error)
            if reason:
                warnings.warn(f"the link 'latest' to the logs of this launch is not made: {reason}", stacklevel=2)
        return self._log_dir

    @log_dir.setter
    def log_dir(self, new_log_dir: str | None) -> None:
        if new_log_dir is not None and not Path(new_log_dir).is_dir():
            raise LogConfigError(f"the folder of the logs is not there: {new_log_dir}")
        if new_log_dir is not None and self.file_handlers:
            warnings.warn(f"log files are open already in {self._log_dir}; only new ones are elsewhere", stacklevel=2)
        self._log_dir = new_log_dir

    @property
    def log_handler_factory(self) -> Callable[..., Any]:
        """Maker of the handler of a file: it gets the path and `encoding=`."""
        default = handlers.FileHandler if sys.platform == "win32" else handlers.WatchedFileHandler
        return self._log_handler_factory or default

    @log_handler_factory.setter
    def log_handler_factory(self, new_log_handler_factory: Callable[..., Any] | None) -> None:
        self._log_handler_factory = new_log_handler_factory

    def set_screen_format(self, screen_format: str | None, *, screen_style: str | None = None) -> None:
        """Set the format of the terminal.

        Args:
            screen_format: As `logging.Formatter` takes it, or `default` or `default_with_timestamp`. The variable
                OVERRIDE_LAUNCH_SCREEN_FORMAT counts more.
            screen_style: Style of the format, `{` if it is None; raises LogConfigError beside a name.
        """
        self.screen_formatter = _formatter(screen_format, screen_style, _SCREEN, "OVERRIDE_LAUNCH_SCREEN_FORMAT")
        if self.screen_handler is not None:
            self.screen_handler.setFormatter(self.screen_formatter)

    def set_log_format(self, log_format: str | None, *, log_style: str | None = None) -> None:
        """Set the format of the log files.

        Args:
            log_format: As `logging.Formatter` takes it, or `default`. The variable OVERRIDE_LAUNCH_LOG_FORMAT
                counts more.
            log_style: Style of the format, `{` if it is None; raises LogConfigError beside a name.
        """
        self.file_formatter = _formatter(log_format, log_style, _FILE, "OVERRIDE_LAUNCH_LOG_FORMAT")
        for each in self.file_handlers.values():
            each.setFormatter(self.file_formatter)

    def get_screen_handler(self) -> Any:
        """Return the handler of the terminal."""
        if self.screen_handler is None:
            self.screen_handler = handlers.StreamHandler(_Screen())
            self.screen_handler.setFormatter(self.screen_formatter)
        return self.screen_handler

    def get_log_file_path(self, file_name: str = "launch.log") -> str:
        """Return the path of the log file called `file_name`."""
        return os.path.join(self.log_dir, file_name)  # noqa: PTH118

    def get_log_file_handler(self, file_name: str = "launch.log") -> Any:
        """Return the handler of the log file called `file_name`, always the same one."""
        if file_name not in self.file_handlers:
            handler = self.log_handler_factory(self.get_log_file_path(file_name), encoding="utf-8")
            handler.setFormatter(self.file_formatter)
            self.file_handlers[file_name] = handler
        return self.file_handlers[file_name]


def _formatter(
    given: str | None, style: str | None, named: Mapping[str, str], variable: str
) -> logging.Formatter | None:
    if os.environ.get(variable):
        given, style = os.environ[variable].encode("latin1", "backslashreplace").decode("unicode_escape"), "{"
    if given is None:
        return None
    if given in named and style is not None:
        raise LogConfigError(f"the format '{given}' has a style of its own")
    return logging.Formatter(named.get(given, given), style=style or "{")  # type: ignore[arg-type]


launch_config = LaunchConfig()
_loggers: dict[str | None, logging.Logger] = {}


def log_launch_config(*, logger: logging.Logger = logging.root) -> None:
    """Log by `logger` where the log files are, and from which level on is logged."""
    if launch_config.file_handlers:
        logger.info(f"All log files can be found below {launch_config.log_dir}")
    logger.info(f"Default logging verbosity is set to {logging.getLevelName(launch_config.level)}")


def get_logger(name: str | None = None) -> logging.Logger:
    """Return the logger called `name`, which writes to the terminal and to the launch's log file."""
    logger = _own(name)
    _add(logger, launch_config.get_screen_handler())
    _add(logger, launch_config.get_log_file_handler())
    return logger


def get_output_loggers(process_name: str, output_config: Any) -> tuple[logging.Logger, logging.Logger]:
    """Return the loggers of what a process writes to its standard output and to its standard errors.

    Args:
        process_name: Name of the process.
        output_config: `screen`, `log`, `both`, `own_log` or `full`, or for each of `stdout`, `stderr` and `both` where
            it goes: one or several of `screen`, `log` (the launch's log file) and `own_log` (a file of its own). Raises
            LogConfigError for anything else.
    """
    targets = _targets(output_config)
    loggers = []
    for source in ("stdout", "stderr"):
        logger = _own(f"{process_name}-{source}")
        both = targets["both"] | targets[source]
        if "screen" in both:
            _add(logger, launch_config.get_screen_handler(), "{msg}")
        if "log" in both:
            _add(logger, launch_config.get_log_file_handler(), "{created:.7f} {msg}")
        if "own_log" in targets[source]:
            _add(logger, launch_config.get_log_file_handler(f"{process_name}-{source}.log"), "{msg}")
        if "own_log" in targets["both"]:
            _add(logger, launch_config.get_log_file_handler(f"{process_name}.log"), "{msg}")
        loggers.append(logger)
    return loggers[0], loggers[1]


def _targets(given: Any) -> dict[str, set[str]]:
    """Return where the output goes, by source, as `get_output_loggers` takes it."""
    if isinstance(given, str):
        if given not in _ALIASES:
            raise LogConfigError(f"output is one of {', '.join(_ALIASES)}, got '{given}'")
        given = _ALIASES[given]
    if not isinstance(given, Mapping):
        raise LogConfigError(f"output is a name or a mapping, got {type(given).__name__}")
    found: dict[str, set[str]] = {each: set() for each in _SOURCES}
    for source, some in given.items():
        if source not in _SOURCES:
            raise LogConfigError(f"what a process writes is {', '.join(_SOURCES)}, got '{source}'")
        found[source] = {some} if isinstance(some, str) else set(some)
        _check_targets(found[source])
    return found


def _check_targets(given: Iterable[str]) -> None:
    for each in given:
        if each not in _TARGETS:
            raise LogConfigError(f"output goes to {', '.join(_TARGETS)}, got '{each}'")


def _own(name: str | None) -> logging.Logger:
    """Return a logger of launch's: what it logs is not logged by those above it once more."""
    logger = logging.getLogger(name)
    if logger is not logging.root:
        logger.propagate = False
    return _loggers.setdefault(name, logger)


def _add(logger: logging.Logger, handler: Any, text: str = "") -> None:
    if handler not in logger.handlers:
        if text:
            handler.setFormatterFor(logger, logging.Formatter(text, style="{"))
        logger.addHandler(handler)


def reset() -> None:
    """Set all as it is at first, and take the handlers from all loggers of launch's."""
    for logger in _loggers.values():
        logger.setLevel(logging.NOTSET)
        del logger.handlers[:]
    launch_config.reset()
