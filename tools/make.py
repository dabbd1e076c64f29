"""What `make demo` and `make test` do, for systems without make: `python tools/make.py demo` or `test`."""

from __future__ import annotations

import signal
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parent.parent
VENV = ROOT / ".venv"
COMMANDS = {
    "demo": ["-m", "robolink", "launch", "wander"],
    "test": ["-m", "pytest", "-n", "3", "--dist", "loadfile", "--no-loadscope-reorder"],
}
"""What Python is given; the Makefile says the same."""
INSTALLING = [
    ["-m", "pip", "install", "--quiet", "--upgrade", "pip"],
    ["-m", "pip", "install", "--quiet", "--editable", ".[dev]"],
]


def main(words: list[str]) -> int:
    """Do what is asked for, in a virtual environment that is made if it is missing; give the exit code."""
    if not words or words[0] not in COMMANDS:
        print(f"usage: python tools/make.py {' | '.join(COMMANDS)}", file=sys.stderr)  # noqa: T201
        return 2
    if sys.version_info < (3, 10):  # noqa: UP036 - who runs this may have any Python
        print("robolink needs Python 3.10 or newer", file=sys.stderr)  # noqa: T201
        return 1
    return prepare() or run([str(python()), *COMMANDS[words[0]], *words[1:]])


def prepare() -> int:
    """Make the virtual environment, unless it is newer than what is to be in it; give the exit code."""
    ready, wanted = VENV / ".ready", ROOT / "pyproject.toml"
    if ready.exists() and ready.stat().st_mtime >= wanted.stat().st_mtime:
        return 0
    steps = [[sys.executable, "-m", "venv", str(VENV)], *([str(python()), *each] for each in INSTALLING)]
    for step in steps:
        if code := run(step):
            return code
    ready.touch()
    return 0


def python() -> Path:
    """Give the virtual environment's Python."""
    return VENV / ("Scripts/python.exe" if sys.platform == "win32" else "bin/python")


def run(command: list[str]) -> int:
    """Run a command until its end; give its exit code. A Ctrl-C, which it gets as well, is for it alone."""
    before = signal.signal(signal.SIGINT, lambda number, frame: None)
    try:
        return subprocess.call(command, cwd=ROOT)
    finally:
        signal.signal(signal.SIGINT, before)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
