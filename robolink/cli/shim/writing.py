"""Writer of the commands that lead from another command's name to robolink; it never touches a file of others.

On Windows such a command is a copy of robolink's own launcher, `robolink.exe`, as pip or uv has made it, and robolink
goes by the name under which it was called. A script `ros2.cmd` would not do: it is read in the console's code page, so
that the path of a home with accents is not found; at Ctrl-C it asks whether to end the batch job; and Git Bash finds no
`.cmd` by its bare name.
"""

from __future__ import annotations

import ntpath
import os
import re
import shutil
import sys
import sysconfig
import zipfile
from pathlib import Path

from robolink.exceptions import RobolinkError
from robolink.system.files import is_file

MARK = "Made by 'robolink shim"
"""Text by which a script is known as one of these."""

_POSIX = """\
#!/bin/sh
# {mark} {name}'; 'robolink shim {name} --remove' takes it away.
exec '{python}' {flag}-c 'import sys
from {module} import main
sys.exit(main())' "$@"
"""
_OURS = re.compile(rb"from robolink\.cli\.main import main\b")
"""Code in a launcher by which it is known as robolink's own."""


class ShimError(RobolinkError, OSError):
    """A command cannot be written, or there is none to remove."""


def scripts_folder() -> Path:
    """Return the folder of the commands of this Python's environment."""
    return Path(sysconfig.get_path("scripts"))


def is_on_path(folder: Path) -> bool:
    """Return whether a shell finds commands in `folder`."""
    return _spelt(str(folder)) in map(_spelt, os.environ.get("PATH", "").split(os.pathsep))


def _spelt(folder: str) -> str:
    """Return a folder's path as it is compared: Windows has one folder by many spellings."""
    return ntpath.normcase(ntpath.normpath(folder.strip('"'))) if sys.platform == "win32" else folder


def write(folder: Path, name: str, module: str, *, force: bool = False) -> Path:
    """Write the command `name`, and return its path.

    Args:
        folder: Folder of commands.
        name: Name of the command.
        module: Module whose `main` it calls.
        force: True writes it also if it hides another command of this name, or replaces it.

    Raises:
        ShimError: (an OSError) if there is another command of this name, or if it cannot be written.
    """
    path = _path(folder, name)
    other = path if is_file(path) else Path(shutil.which(name) or path)
    if not force and is_file(other) and not _is_ours(other):
        verb = "replace" if other == path else "hide"
        raise ShimError(f"{other} is a real {name}, which this one would {verb}; --force writes it all the same")
    content = _launcher().read_bytes() if sys.platform == "win32" else _script(name, module).encode()
    try:
        if not is_file(path) or path.read_bytes() != content:  # Windows lets nobody write the command that runs now
            path.write_bytes(content)
        path.chmod(0o755)
        _remove_older(folder, name)
    except OSError as error:
        raise ShimError(f"{path} cannot be written: {error.strerror}") from None
    return path


def _script(name: str, module: str) -> str:
    python, flag = sys.executable.replace("'", "'\\''"), "-P " if sys.version_info >= (3, 11) else ""
    return _POSIX.format(mark=MARK, name=name, python=python, module=module, flag=flag)


def _launcher() -> Path:
    """Return robolink's own launcher: that of the command that runs, of this environment, or on the PATH."""
    folders = [Path(sys.argv[0]).absolute().parent, scripts_folder()]
    found = [*(each / "robolink.exe" for each in folders), *map(Path, filter(None, [shutil.which("robolink.exe")]))]
    for each in found:
        if is_file(each) and _is_ours(each):
            return each
    raise ShimError(f"robolink.exe, which is copied, is neither in {scripts_folder()} nor on the PATH: pip makes it")


def _remove_older(folder: Path, name: str) -> None:
    """Remove the script of this name that robolink 0.2 made on Windows."""
    if is_file(script := folder / f"{name}.cmd") and _is_ours(script):
        script.unlink()


def remove(folder: Path, name: str) -> Path:
    """Remove the command `name` from `folder`, and return its path. Raises ShimError if it is not one of these."""
    path = _path(folder, name)
    if not is_file(path):
        raise ShimError(f"{path} is not there")
    if not _is_ours(path):
        raise ShimError(f"{path} was not made by 'robolink shim': it stays")
    path.unlink()
    _remove_older(folder, name)
    return path


def _path(folder: Path, name: str) -> Path:
    return folder / (f"{name}.exe" if sys.platform == "win32" else name)


def _is_ours(path: Path) -> bool:
    try:
        with path.open("rb") as file:
            begin = file.read(500)
        if MARK.encode() in begin:
            return True
        if path.suffix != ".exe":
            return False
        with zipfile.ZipFile(path) as program:  # the launcher has it at its end
            return _OURS.search(program.read("__main__.py")) is not None
    except (OSError, KeyError, zipfile.BadZipFile):
        return False
