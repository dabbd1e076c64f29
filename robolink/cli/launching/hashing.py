"""Fixed hash seed for `simulate`: restarts the process with PYTHONHASHSEED=0, so that sets of texts keep their order.

Python takes the seed when it starts, so a process without one restarts, before it does anything that takes time.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Mapping, Sequence

SEED = "PYTHONHASHSEED"
STEADY = "0"
COMMAND = "simulate"
NETWORK = "--network"
"""Option of the root command that takes a value."""

HELD = "ROBOLINK_HOLDS_INTERRUPT"
"""Environment variable of a restarted process: a Ctrl-C has been held back until now."""


def begin_steadily(args: Sequence[str]) -> None:
    """Restart this process with a fixed hash seed, if its words are those of a simulation.

    It goes on without a restart if a seed is given, if hashes are not random, and if the process was not started
    with these words or cannot be started again. Raises KeyboardInterrupt, in the restarted process, for a Ctrl-C that
    came meanwhile.
    """
    if os.environ.pop(HELD, None):
        _release_interrupt()
    if sys.flags.hash_randomization and not os.environ.get(SEED) and is_simulation(args):
        again = _command(args)
        if again:
            _begin_anew(again, {**os.environ, SEED: STEADY})


def is_simulation(args: Sequence[str]) -> bool:
    """True if `robolink ARGS` simulates.

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
    """Return the words that start this process again; none if that is not possible."""
    began = sys.orig_argv
    own = began[1 : len(began) - len(args)]  # of Python: its options, and the script, the module or the text
    is_mine = list(began[len(began) - len(args) :]) == list(args)
    has_code = bool(own) and own[-1] != "-"  # else it came by standard input, and is gone
    return [sys.executable, *began[1:]] if sys.executable and is_mine and has_code else []


def _begin_anew(command: Sequence[str], environ: Mapping[str, str]) -> None:
    """Replace this process by another; go on as this one if that fails."""
    try:
        if sys.platform == "win32":
            os._exit(as_signed(stand_in_for(command, environ)))
        else:
            _become(command, environ)
    except OSError:
        return


def as_signed(code: int) -> int:
    """Return an exit code as `os._exit` takes it: Windows has codes of 32 bits, 0xC0000005 for a crash, Python an int.

    >>> as_signed(0xC0000005), as_signed(1)
    (-1073741819, 1)
    """
    return code - 2**32 if code >= 2**31 else code


def _become(command: Sequence[str], environ: Mapping[str, str]) -> None:
    """Replace this process by another (exec); a Ctrl-C in between is blocked until the other can handle it."""
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
    """Run a command in this one's place and return its exit code: Windows has no exec.

    Ctrl-C is left to the other process, which gets it as well.
    """
    import signal
    import subprocess

    for name in ("SIGINT", "SIGBREAK"):
        if hasattr(signal, name):
            signal.signal(getattr(signal, name), signal.SIG_IGN)
    return subprocess.call(command, env=environ)
