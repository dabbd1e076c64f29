"""Build script: installs robolink into a virtual environment; `make demo` and `make test` where there is no make.

    python tools/make.py demo
    python tools/make.py test [ARGUMENTS OF PYTEST]...
    python tools/make.py docs
    python tools/make.py [--venv FOLDER] install-demo | install-test | install-docs     the first half of each

It runs with Python 3.6 and its standard library, so that whoever has an older Python than robolink needs is told so.
"""

import shutil
import signal
import subprocess
import sys
import sysconfig
from pathlib import Path
from typing import Dict, List, NamedTuple, Tuple

OLDEST = (3, 10)
NEWEST = 20
"""As far as this Python's younger sisters are looked for: 3.20."""
EDITABLE_SINCE, GROUPS_SINCE = (21, 3), (25, 1)
"""The pips that can install a pyproject.toml as editable, and its dependency groups; Pythons bring older ones."""

NO_WHEELS = {"win32": "32-bit Windows", "win-arm32": "Windows on ARM", "win-arm64": "Windows on ARM"}
"""Systems, as Python names them, without wheels of Zenoh, pymunk or OpenCV. Windows on ARM runs Python for x64."""

ROOT = Path(__file__).resolve().parent.parent
USAGE = "usage: python tools/make.py demo | test | docs"


class Stage(NamedTuple):
    """One of the stages of installing: the file that says it is there, its dependency group, and that in words."""

    marker: str
    group: str
    words: str


STAGES: Dict[str, Stage] = {
    "demo": Stage(".demo", "", "installing what it needs, some 160 MB"),
    "test": Stage(".ready", "dev", "installing what it needs and its developers' tools, some 540 MB"),
    "docs": Stage(".docs", "docs", "installing what it needs and what builds the site, some 250 MB"),
}
INSTALLING = {"install-" + name: name for name in STAGES}
COMMANDS: Dict[str, List[str]] = {
    "demo": ["-m", "robolink", "launch", "wander", "--view"],
    "docs": ["-m", "tools.docs_site"],
    "test": ["-m", "pytest", "-n", "4", "--dist", "loadfile", "--no-loadscope-reorder"],
}
"""What Python is given; the Makefile says the same."""

QUIETLY = (
    "import runpy, signal, sys; signal.signal(signal.SIGINT, signal.SIG_DFL); "
    "runpy.run_module(sys.argv.pop(1), run_name='__main__', alter_sys=True)"
)
"""Runs a module as `python -m` does, but a Ctrl-C ends it at once: pip and venv would print their tracebacks."""
INTERRUPTED = (-signal.SIGINT, 0xC000013A)
"""The exit codes of a program that a Ctrl-C has ended: POSIX's and Windows'."""


def main(words: List[str]) -> int:
    """Carry out what the words ask for; return the exit code."""
    venv = ROOT / ".venv"
    if words[:1] == ["--venv"] and len(words) > 1:
        venv, words = Path(words[1]).absolute(), words[2:]
    what = words[0] if words else ""
    if what in INSTALLING:
        return install(INSTALLING[what], venv, "make {} PYTHON={}")
    if what not in COMMANDS:
        print(USAGE, file=sys.stderr)
        return 2
    code = install(what, venv, "{1} tools/make.py {0}")
    if code:
        return code
    if what == "demo":
        tell("a robot wanders in a simulated room, in the browser: Ctrl-C ends it")
    return run([str(python_of(venv))] + COMMANDS[what] + words[1:])


def install(name: str, venv: Path, other: str) -> int:
    """Install what a command needs, unless it is there and newer than pyproject.toml; return the exit code.

    `other` is how the command is given another Python.
    """
    if is_there(name, venv):
        return 0
    lack = lacking(name, other)
    if lack:
        print(lack, file=sys.stderr)
        return 1
    for words, step in steps(name, venv):
        tell(words)
        code = run(step)
        if code in INTERRUPTED:
            print("\nrobolink is not installed yet: the same command goes on with it", file=sys.stderr)
            return 130
        if code:
            print("robolink is not installed: the step above failed", file=sys.stderr)
            return code
    for each in ("demo", name):  # who has the tools has all that a demo needs
        (venv / STAGES[each].marker).touch()
    return 0


def is_there(name: str, venv: Path) -> bool:
    """Return whether what a command needs is installed, as pyproject.toml has it today."""
    marker = venv / STAGES[name].marker
    return marker.exists() and marker.stat().st_mtime >= (ROOT / "pyproject.toml").stat().st_mtime


def lacking(name: str, other: str) -> str:
    """Return why this Python cannot install robolink, and what could; nothing if it can."""
    this = "{}.{}.{}".format(*sys.version_info[:3])
    if sys.version_info[:2] < OLDEST:
        names = ["python{}.{}".format(OLDEST[0], minor) for minor in range(NEWEST, OLDEST[1] - 1, -1)]
        found = next(filter(runs, names), "")
        advice = "here is a newer one: " + other.format(name, found) if found else "install one from python.org"
        expected = "{}.{}".format(*OLDEST)
        return "robolink needs Python {} or newer, and {} is {}; {}".format(expected, sys.executable, this, advice)
    if sysconfig.get_platform() in NO_WHEELS:
        return "this Python ({}) is for {}, for which libraries that robolink needs have no wheels; {}".format(
            sys.executable, NO_WHEELS[sysconfig.get_platform()], "install the 64-bit (x64) Python from python.org"
        )
    try:
        __import__("ensurepip"), __import__("venv")
    except ImportError:
        return "this Python ({}) lacks venv: on Debian and Ubuntu, sudo apt install python3-venv".format(this)
    return ""


def runs(python: str) -> bool:
    """Return whether there is a Python of this name; pyenv has names for what is not chosen."""
    return shutil.which(python) is not None and not subprocess.call([python, "-c", ""], stderr=subprocess.DEVNULL)


def steps(name: str, venv: Path) -> List[Tuple[str, List[str]]]:
    """List what is to be run for an installation, each with the line that tells of it."""
    import ensurepip

    python = str(python_of(venv))
    pip = quietly(python, "pip", "install", "--quiet", "--disable-pip-version-check")
    stage = STAGES[name]
    made = []
    whole = any((venv / each.marker).exists() for each in STAGES.values())
    if not whole or not python_of(venv).exists():
        this = "{}.{}.{}".format(*sys.version_info[:3])
        made.append(("making a virtual environment with Python {} in {}".format(this, venv), venv_command(venv)))
    needed = GROUPS_SINCE if stage.group else EDITABLE_SINCE
    if tuple(int(each) for each in ensurepip.version().split(".")[:2]) < needed:
        made.append(("installing a newer pip", [*pip, "pip>={}.{}".format(*needed)]))
    editable = [] if reads_paths_by_locale() else ["--editable"]
    made.append((stage.words, [*pip, *editable, ".", *(["--group", stage.group] if stage.group else [])]))
    return made


def reads_paths_by_locale() -> bool:
    """Return whether this Python would not find an editable installation of this clone.

    Its place stands in a `.pth` file in UTF-8, which Windows' Python before 3.13 reads in the country's own letters.
    What is run from here, as all commands of this file, finds the clone itself all the same.
    """
    return sys.platform == "win32" and sys.version_info < (3, 13) and any(ord(each) > 127 for each in str(ROOT))


def venv_command(venv: Path) -> List[str]:
    """Return the command that makes a virtual environment."""
    return quietly(sys.executable, "venv", str(venv))


def quietly(python: str, *words: str) -> List[str]:
    """Return the command that runs a module with its arguments, and without a word when it is interrupted."""
    return [python, "-c", QUIETLY, *words]


def python_of(venv: Path) -> Path:
    """Return a virtual environment's Python."""
    return venv / ("Scripts/python.exe" if sys.platform == "win32" else "bin/python")


def tell(words: str) -> None:
    """Print the next step, at once."""
    print("robolink: " + words, flush=True)


def run(command: List[str]) -> int:
    """Run a command until its end; return its exit code. A Ctrl-C, which it gets as well, is for it alone."""
    before = signal.signal(signal.SIGINT, lambda number, frame: None)
    try:
        return subprocess.call(command, cwd=str(ROOT))
    finally:
        signal.signal(signal.SIGINT, before)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
