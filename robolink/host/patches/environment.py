"""View that each program has of the process: command line, environment, standard input, main module."""

from __future__ import annotations

import os
import sys
from pathlib import Path

from robolink.host.participants import ProgramLike
from robolink.system.processes import set_environment


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
