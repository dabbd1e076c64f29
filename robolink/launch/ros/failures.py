"""Errors of ROS 2 launch files: one line each, at the file and line of the user's own code."""

from __future__ import annotations

import os
import re
import site
import sys
import sysconfig
import traceback
from pathlib import Path

from robolink.companions.ament_index.packages import NOT_HERE, package_not_here
from robolink.companions.launch.bases import LaunchError, Place, no_argument
from robolink.exceptions import DocumentError, RobolinkError
from robolink.interfaces.standard import FOLDER
from robolink.system.terminal import shown

_NOT_USERS = [
    str(Path(__file__).resolve().parents[2]),
    sysconfig.get_paths()["stdlib"],
    *site.getsitepackages(),
    sys.prefix,
]
"""Folders of robolink and of libraries. Looked up early: sysconfig imports modules, and imports ask `is_users`."""
_LONGEST = 400
_UNEXPECTED = re.compile(r"(?:(\w+)\.)?(\w+)\(\) got an unexpected keyword argument '(\w+)'")
_LACKING = re.compile(r"(\w+)\.__init__\(\) missing \d+ required (?:[a-z-]+ )*arguments?: (.+)")
_PATH = re.compile("(?:" + "|".join(re.escape(str(each)) for each in (NOT_HERE, FOLDER)) + r")[^\s'\",;:]*")


def as_document_error(error: BaseException, place: Place) -> DocumentError:
    """Return an error of a launch file as one line with its place.

    Args:
        error: Error that the file, or an action of it, has raised.
        place: Place that counts if the error comes from no line of the user's.
    """
    if isinstance(error, DocumentError):
        return error
    if isinstance(error, SyntaxError) and error.filename:
        return DocumentError(error.msg, error.filename, error.lineno or 0, error.offset or 0)
    at = place if isinstance(error, LaunchError) and place.line else users_place(error) or place
    return DocumentError(reason_of(error).removeprefix(f"{at.file}: "), at.file, at.line)


def reason_of(error: BaseException) -> str:
    """Return an error's text in one line, with its kind if it is none of robolink's."""
    missing = absent_package(error)
    if missing:
        return f"package {missing} is not here, and its {_within(str(error))} is needed"
    if isinstance(error, RobolinkError):
        return shown(str(error), _LONGEST)
    refused = _UNEXPECTED.search(str(error)) if isinstance(error, TypeError) else None
    if refused is not None:
        return _no_argument(error, refused[1] or refused[2], refused[3])
    lacking = _LACKING.search(str(error)) if isinstance(error, TypeError) else None
    if lacking is not None:
        return f"{lacking[1]} needs {lacking[2]}"
    if isinstance(error, KeyError) and _is_of_environment(error):
        name = shown(str(error.args[0]))
        return f"the environment has no '{name}', which this file needs: set it, as by export {name}=VALUE"
    if isinstance(error, RecursionError):
        return "it never ends: a function or a substitution calls itself"
    if isinstance(error, SystemExit):
        return f"it ends the program: sys.exit({shown(repr(error.code), _LONGEST)})"
    if isinstance(error, MemoryError):
        return "there is not enough memory for it"
    text = shown(str(error), _LONGEST)
    return f"{type(error).__name__}: {text}" if text else type(error).__name__


def _is_of_environment(error: KeyError) -> bool:
    """True if `os.environ[NAME]` has raised an error."""
    last = [frame for frame, _ in traceback.walk_tb(error.__traceback__)][-1:]
    return any(each.f_code is os.environ.__class__.__getitem__.__code__ for each in last)


def absent_package(error: BaseException) -> str:
    """Return the package that is not here and whose file an error is about; '' if it is about something else."""
    found = _PATH.search(str(error))
    return package_not_here(found[0]) if found else ""


def _within(text: str) -> str:
    found = _PATH.search(text)
    path = found[0] if found else ""
    parts = Path(path).parts
    package = package_not_here(path)
    return shown("/".join(parts[parts.index(package) + 1 :]) if package in parts else "") or "folder"


def _no_argument(error: BaseException, name: str, argument: str) -> str:
    """Return why a call has a wrong keyword, with the nearest of the class, if it is one that the caller knows."""
    for frame, _ in traceback.walk_tb(error.__traceback__):
        cls = frame.f_globals.get(name)
        if isinstance(cls, type):
            return str(no_argument(cls, argument))
    return f"{name} has no argument '{argument}'"


def users_place(error: BaseException) -> Place | None:
    """Return the last line of the user's own code that an error came through."""
    lines = [Place(frame.f_code.co_filename, line) for frame, line in traceback.walk_tb(error.__traceback__)]
    return next((each for each in reversed(lines) if is_users(each.file)), None)


def is_users(file: str) -> bool:
    """Return whether a file of Python code is the user's: neither robolink's nor of a library."""
    if file.startswith("<"):
        return False
    return not any(Path(file).is_relative_to(each) for each in _NOT_USERS)
