"""View that each program has of the process (command line, environment, standard input), and its state afterwards."""

from __future__ import annotations

import logging
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from robolink.host.participants import ProgramLike
from robolink.system.processes import set_environment
from robolink.workspace.interfaces import WORKSPACE_TYPES


class ProcessView:
    """Shows one program at a time; standard input is empty, as in a process without a terminal."""

    def __init__(self) -> None:
        self.shown: ProgramLike | None = None
        self._main, self._argv, self._stdin = sys.modules["__main__"], sys.argv, sys.stdin
        self._no_stdin = Path(os.devnull).open(encoding="utf-8")  # noqa: SIM115 - closed with the host
        self._environment: dict[str, str | None] = {}
        self.env: dict[str, str | None] = {}
        """Variables added to the process's environment."""

    def show(self, program: ProgramLike | None) -> None:
        """Show what is this program's; with None, what is the process's."""
        self.shown = program
        if program is None:
            sys.argv, sys.stdin, sys.modules["__main__"] = self._argv, self._stdin, self._main
            self._set({})
            return
        sys.argv, sys.stdin = program.argv, self._no_stdin
        sys.modules["__main__"] = program.main_module or self._main
        self._set(program.env)

    def _set(self, env: dict[str, str | None]) -> None:
        if env == self.env:
            self.env = env
            return
        self.env = env
        set_environment(self._environment)
        self._environment = {name: os.environ.get(name) for name in env}
        set_environment(env)

    def close(self) -> None:
        """Show what is the process's, for good."""
        self.show(None)
        self._no_stdin.close()


@contextmanager
def process_as_before() -> Iterator[None]:
    """Restore the process's state at the end of a `with`: one test's nodes change nothing for those of the next.

    It is the working directory, the environment, standard output and errors, `sys.path`, the workspaces whose types
    are known, and the levels of Python's own logging.
    """
    folder, environment, path = _working_directory(), dict(os.environ), list(sys.path)
    streams, levels, disabled = (sys.stdout, sys.stderr), _levels(), logging.root.manager.disable
    try:
        with WORKSPACE_TYPES.forgetting():
            yield
    finally:
        if _working_directory() != folder:
            with suppress(OSError):  # that folder is gone
                os.chdir(folder)
        if os.environ != environment:
            set_environment({**dict.fromkeys(os.environ), **environment})
        sys.path[:] = path
        if not any(getattr(each, "closed", False) for each in streams):  # pytest takes its own away after Ctrl-C
            sys.stdout, sys.stderr = streams
        logging.disable(disabled)
        for logger, level in _levels().items():
            before = levels.get(logger, logging.NOTSET)
            if level != before:  # setLevel clears the caches of all loggers
                logger.setLevel(before)


def _working_directory() -> str:
    with suppress(OSError):  # it is gone
        return os.getcwd()  # noqa: PTH109 - in the words that os.chdir takes
    return ""


def _levels() -> dict[logging.Logger, int]:
    """Return the levels of all loggers."""
    named = (each for each in list(logging.root.manager.loggerDict.values()) if isinstance(each, logging.Logger))
    return {each: each.level for each in (logging.root, *named)}
