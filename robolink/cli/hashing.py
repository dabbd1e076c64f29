"""Has `simulate` run in a Python whose hashes of texts are always the same: so is the order of their sets.

Python takes their seed when it begins, so what runs without one begins anew, before anything that takes time is done.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Mapping, Sequence

SEED = "PYTHONHASHSEED"
STEADY = "0"
COMMAND = "simulate"
NETWORK = "--network"
"""The option of the root command that takes a value."""

HELD = "ROBOLINK_HOLDS_INTERRUPT"
"""What tells a process that begins anew that a Ctrl-C has been held back until now."""


def begin_steadily(args: Sequence[str]) -> None:
    """Begin this process anew, with no chance in hashes, if its words ask for what is to be the same each time.

    Nothing is done where somebody gave a seed, where hashes are no matter of chance, and where the process was not
    started with these words or cannot be started again. Raises KeyboardInterrupt, in the process that has begun anew,
    for a Ctrl-C that came meanwhile.
    """
    if os.environ.pop(HELD, None):
        _release_interrupt()
    if sys.flags.hash_randomization and not os.environ.get(SEED) and is_simulation(args):
        again = _command(args)
        if again:
            _begin_anew(again, {**os.environ, SEED: STEADY})


def is_simulation(args: Sequence[str]) -> bool:
    """Whether `robolink ARGS` simulates.

    >>> is_simulation(["--network", "off", "simulate", "follow"]), is_simulation(["run", "simulate"])
    (True, False)
    """
    words = iter(args)
    for each in words:
        if each == NETWORK:
            next(words, None)
        elif not each.startswith("-"):
            return each == COMMAND
    return False


def _command(args: Sequence[str]) -> list[str]:
    """Give the words that start this process again; none if that cannot be."""
    began = sys.orig_argv
    own = began[1 : len(began) - len(args)]  # of Python: its options, and the script, the module or the text
    is_mine = list(began[len(began) - len(args) :]) == list(args)
    has_code = bool(own) and own[-1] != "-"  # else it came by standard input, and is gone
    return [sys.executable, *began[1:]] if sys.executable and is_mine and has_code else []


def _begin_anew(command: Sequence[str], environ: Mapping[str, str]) -> None:
    """Become another process; where there is none to be had, go on as this one."""
    try:
        if sys.platform == "win32":
            os._exit(stand_in_for(command, environ))
        else:
            _become(command, environ)
    except OSError:
        return


def _become(command: Sequence[str], environ: Mapping[str, str]) -> None:
    """Turn this process into another; a Ctrl-C in between waits until that one can tell of it in order."""
    if sys.platform != "win32":
        import signal

        is_held = signal.SIGINT in signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGINT])
        try:
            os.execve(command[0], list(command), dict(environ) if is_held else {**environ, HELD: "1"})
        finally:  # there is no such process
            if not is_held:
                _release_interrupt()


def _release_interrupt() -> None:
    if sys.platform != "win32":
        import signal

        signal.pthread_sigmask(signal.SIG_UNBLOCK, [signal.SIGINT])


def stand_in_for(command: Sequence[str], environ: Mapping[str, str]) -> int:
    """Run a command in this one's place and give its exit code: Windows cannot turn a process into another.

    Ctrl-C is the other's to answer, who gets it as well.
    """
    import signal
    import subprocess

    for name in ("SIGINT", "SIGBREAK"):
        if hasattr(signal, name):
            signal.signal(getattr(signal, name), signal.SIG_IGN)
    return subprocess.call(command, env=environ)
