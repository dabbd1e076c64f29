"""Writer of the scripts that lead from another command's name to robolink; it never touches a file of others."""

from __future__ import annotations

import os
import shutil
import sys
import sysconfig
from pathlib import Path

from robolink.exceptions import RobolinkError
from robolink.system.paths import is_file

MARK = "Made by 'robolink shim"
"""Text by which a script is known as one of these."""

_POSIX = """\
#!/bin/sh
# {mark} {name}'; 'robolink shim {name} --remove' takes it away.
exec '{python}' {flag}-c 'import sys
from {module} import main
sys.exit(main())' "$@"
"""
_WINDOWS = """\
@rem {mark} {name}'; 'robolink shim {name} --remove' takes it away.
@"{python}" {flag}-c "import sys; from {module} import main; sys.exit(main())" %*
"""


class ShimError(RobolinkError, OSError):
    """A command cannot be written, or there is none to remove."""


def scripts_folder() -> Path:
    """Return the folder of the commands of this Python's environment."""
    return Path(sysconfig.get_path("scripts"))


def is_on_path(folder: Path) -> bool:
    """Return whether a shell finds commands in `folder`."""
    return str(folder) in os.environ.get("PATH", "").split(os.pathsep)


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
    template = _WINDOWS if sys.platform == "win32" else _POSIX
    python = sys.executable if sys.platform == "win32" else sys.executable.replace("'", "'\\''")
    flag = "-P " if sys.version_info >= (3, 11) else ""
    try:
        path.write_text(
            template.format(mark=MARK, name=name, python=python, module=module, flag=flag), encoding="utf-8"
        )
        path.chmod(0o755)
    except OSError as error:
        raise ShimError(f"{path} cannot be written: {error.strerror}") from None
    return path


def remove(folder: Path, name: str) -> Path:
    """Remove the command `name` from `folder`, and return its path. Raises ShimError if it is not one of these."""
    path = _path(folder, name)
    if not is_file(path):
        raise ShimError(f"{path} is not there")
    if not _is_ours(path):
        raise ShimError(f"{path} was not made by 'robolink shim': it stays")
    path.unlink()
    return path


def _path(folder: Path, name: str) -> Path:
    return folder / (f"{name}.cmd" if sys.platform == "win32" else name)


def _is_ours(path: Path) -> bool:
    try:
        with path.open("rb") as file:
            return MARK.encode() in file.read(500)
    except OSError:
        return False
