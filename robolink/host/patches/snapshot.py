"""Snapshot of the process-global state that programs change, restored when the host closes."""

from __future__ import annotations

import logging
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress

from robolink.system.processes import set_environment
from robolink.workspace.interfaces import WORKSPACE_TYPES


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
