"""colcon as `robolink shim colcon` writes it: its build has nothing to build, and its list shows the packages."""

from __future__ import annotations

import shlex
import sys
from collections.abc import Sequence
from pathlib import Path

from robolink.cli.shared.output import complain, say
from robolink.exceptions import NotFoundError, RobolinkError
from robolink.workspace.installed import COLCON
from robolink.workspace.packages import IGNORE, source_packages

SETUPS = ("setup.bash", "setup.sh", "setup.zsh", "local_setup.bash", "local_setup.sh", "local_setup.zsh")
"""Files that people source after a build; here they say where the workspace is."""
SELECTING = ("--packages-select", "--packages-up-to")
"""Options that name packages."""

_USAGE = "colcon build | colcon list | colcon test"
_NOTE = "# Made by robolink's colcon: robolink finds the packages in src/, from any folder once this is sourced.\n"
_SETUP = _NOTE + "export {variable}={folder}${{{variable}:+:${variable}}}\n"


def main(args: Sequence[str] | None = None) -> int:
    """Run a verb of colcon, and return the exit code; `args` are its words, None takes those of the process."""
    verb, *words = [*(sys.argv[1:] if args is None else args), ""][:-1] or [""]
    try:
        match verb:
            case "build":
                return _build(words)
            case "list":
                return _list()
            case "test" | "test-result":
                say("tests are pytest's, and need no build: run 'pytest' in the package, or in the workspace")
                return 0
            case "" | "-h" | "--help":
                say(f"{_USAGE}; made by 'robolink shim colcon': nothing has to be built")
                return 0
        return complain(f"colcon {verb} is not here: {_USAGE}", 2)
    except (RobolinkError, OSError) as error:
        return complain(error)


def _build(words: Sequence[str]) -> int:
    """Check that the packages are there, and write the files that people source after a build."""
    known = source_packages(Path.cwd())
    for name in _selected(words):
        if name not in known:
            raise NotFoundError("package", name, known, str(Path.cwd()))
    count = f"{len(known)} package{'s' if len(known) != 1 else ''}"
    say(f"{count} found, nothing has to be built: 'robolink run' and 'robolink launch' take them as they are")
    if known:
        _write_setups(Path("install"))
    return 0


def _selected(words: Sequence[str]) -> list[str]:
    """Return the packages that options select: all words up to the next option."""
    names, is_selecting = [], False
    for each in words:
        if each.startswith("-"):
            is_selecting = each in SELECTING
        elif is_selecting:
            names.append(each)
    return names


def _write_setups(folder: Path) -> None:
    """Write files that name the workspace when they are sourced, unless something was built before."""
    if folder.exists() and not _is_ours(folder / SETUPS[0]):
        return
    folder.mkdir(exist_ok=True)
    (folder / IGNORE[0]).touch()
    text = _SETUP.format(variable=COLCON, folder=shlex.quote(str(folder.absolute())))
    for name in SETUPS:
        (folder / name).write_text(text, encoding="utf-8")


def _is_ours(setup: Path) -> bool:
    try:
        return setup.read_bytes().startswith(b"# Made by robolink's colcon")
    except OSError:
        return False


def _list() -> int:
    here = Path.cwd()
    for name, folder in sorted(source_packages(here).items()):
        kind = "ament_python" if (folder / "setup.py").is_file() else "ament_cmake"
        place = folder.relative_to(here) if folder.is_relative_to(here) else folder
        say(f"{name}\t{place}\t(ros.{kind})")
    return 0
