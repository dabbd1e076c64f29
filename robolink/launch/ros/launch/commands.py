"""Substitutions that run a command or an expression, find a program or read a file (`launch.substitutions`)."""

from __future__ import annotations

import importlib
import importlib.util
import shutil
import sys
import threading
from collections.abc import Mapping
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any

from robolink.launch.ros.launch.bases import (
    LaunchContext,
    SomeSubstitutionsType,
    Substitution,
    SubstitutionFailure,
    described,
)
from robolink.launch.ros.launch.utilities import normalize_to_list_of_substitutions, perform_substitutions
from robolink.system.files import decoded, read_plain
from robolink.system.processes import split_words
from robolink.system.terminal import shown

if TYPE_CHECKING:
    import subprocess


class ExpressionNameError(SubstitutionFailure, NameError):
    """An expression has a name that is not there: one of a module, say, that it does not have."""


_REACTIONS = ("fail", "ignore", "warn", "capture")
_SHOWN = 300
PATIENCE = 120.0
"""Longest run of a command, in seconds."""
LONGEST = 32 << 20
"""Most bytes of a command's output, or of a file."""


class Command(Substitution):
    """Output of a command, such as `xacro robot.urdf.xacro`.

    Args:
        command: The command line; it is split as a shell does.
        on_stderr: Reaction to lines on its standard error: fail, ignore, warn, or capture, which adds them.
    """

    def __init__(self, command: SomeSubstitutionsType, *, on_stderr: SomeSubstitutionsType = "fail") -> None:
        self.command = normalize_to_list_of_substitutions(command)
        self.on_stderr = normalize_to_list_of_substitutions(on_stderr)

    def perform(self, context: LaunchContext) -> str:
        """Run the command; return its output. Raises SubstitutionFailure if it fails."""
        import subprocess  # few launch files run a command, and all import this module

        text = perform_substitutions(context, self.command)
        reaction = perform_substitutions(context, self.on_stderr)
        if reaction not in _REACTIONS:
            raise SubstitutionFailure(f"on_stderr is one of {', '.join(_REACTIONS)}, got '{shown(reaction)}'")
        words = split_words(text)
        if not words:
            raise SubstitutionFailure("Command has no command")
        is_captured = reaction == "capture"
        errors = subprocess.STDOUT if is_captured else subprocess.PIPE
        try:
            done = _run_bounded(program_of(words, context), errors, context.environment)
        except (OSError, ValueError, subprocess.TimeoutExpired) as error:
            reason = getattr(error, "strerror", None) or str(error)
            raise SubstitutionFailure(f"'{shown(text)}' cannot be run: {reason}") from None
        reported = (done.stderr or b"").decode(errors="replace").strip()
        output = done.stdout.decode(errors="replace")
        if done.returncode or (reported and reaction == "fail"):
            how = f"ended with exit code {done.returncode}" if done.returncode else "wrote to its standard error"
            last = shown((reported or output.strip()).rpartition("\n")[2], _SHOWN)
            raise SubstitutionFailure(f"'{shown(text)}' {how}{': ' if last else ''}{last}")
        return output


def _run_bounded(words: list[str], errors: int, environment: Mapping[str, str]) -> subprocess.CompletedProcess[bytes]:
    """Run a command to its end; one that writes more than LONGEST bytes, or takes too long, is killed.

    Args:
        words: The command.
        errors: Where its standard error goes, as subprocess says it.
        environment: Its environment.

    Raises:
        OSError: if it cannot be run.
        ValueError: if it cannot be run, or writes too much.
        subprocess.TimeoutExpired: if it takes too long.
    """
    import subprocess

    from robolink.system import waits

    with subprocess.Popen(words, stdout=subprocess.PIPE, stderr=errors, env=environment) as process:
        stored: dict[str, bytes] = {}

        def keep(name: str, stream: IO[bytes]) -> None:
            stored[name] = stream.read(LONGEST + 1)
            if len(stored[name]) > LONGEST:
                process.kill()

        streams = {"out": process.stdout, "err": process.stderr}
        readers = [threading.Thread(target=keep, args=each, daemon=True) for each in streams.items() if each[1]]
        for each in readers:
            each.start()
        try:
            process.wait(PATIENCE)
        except BaseException:
            process.kill()
            raise
        for each in readers:
            waits.join(each, PATIENCE)
        if any(len(each) > LONGEST for each in stored.values()):
            raise ValueError(f"it writes more than {LONGEST:,} bytes")
        return subprocess.CompletedProcess(words, process.returncode, stored.get("out", b""), stored.get("err"))


def program_of(words: list[str], context: LaunchContext) -> list[str]:
    """Return a command line, `words`, with the program's path on the PATH of `context`.

    Raises SubstitutionFailure if there is no such program.
    """
    name = Path(words[0]).name
    if name == "xacro" and importlib.util.find_spec("xacro") is not None:
        # Not the script that pip puts on the PATH, whose $(find PACKAGE) needs ament_index_python.
        return [sys.executable, "-m", "robolink", "run", "xacro", "xacro", "--", *words[1:]]
    found = shutil.which(words[0], path=context.environment.get("PATH"))
    if found is not None:
        return [found, *words[1:]]
    if name in ("python", "python3"):
        return [sys.executable, *words[1:]]
    if name == "xacro":
        raise SubstitutionFailure("xacro is not installed: pip install xacro")
    raise SubstitutionFailure(f"no program '{shown(words[0])}' is found on the PATH")


class FindExecutable(Substitution):
    """Path of a program on the PATH.

    Args:
        name: Name of the program.
    """

    def __init__(self, *, name: SomeSubstitutionsType) -> None:
        self.name = normalize_to_list_of_substitutions(name)

    def perform(self, context: LaunchContext) -> str:
        """Return the path; raises SubstitutionFailure if there is no such program.

        Programs that robolink starts itself, `xacro` and `ros2` among them, keep their names.
        """
        name = perform_substitutions(context, self.name)
        found = shutil.which(name, path=context.environment.get("PATH"))
        if found is None and name not in ("xacro", "python", "python3", "robolink", "ros2"):
            raise SubstitutionFailure(f"no program '{shown(name)}' is found on the PATH")
        return found or name


class PythonExpression(Substitution):
    """Value of an expression of Python, as a text.

    Args:
        expression: The expression, in which substitutions may stand.
        python_modules: Names of modules that it may use; those of `math` need no module's name in front.
    """

    def __init__(self, expression: SomeSubstitutionsType, python_modules: SomeSubstitutionsType = ("math",)) -> None:
        self.expression = normalize_to_list_of_substitutions(expression)
        self.python_modules = normalize_to_list_of_substitutions(python_modules)

    def perform(self, context: LaunchContext) -> str:
        """Return the value; raises SubstitutionFailure if the expression fails."""
        text = perform_substitutions(context, self.expression)
        try:
            names: dict[str, Any] = {}
            for each in self.python_modules:
                name = each.perform(context)
                names[name] = importlib.import_module(name)
                if name == "math":
                    names.update(vars(names[name]))
            return str(eval(text, names))  # noqa: S307 - the launch file is a program, this is a part of it
        except Exception as error:  # noqa: BLE001 - whatever the expression raises
            reason = f"{type(error).__name__}: {error}"
            kind = ExpressionNameError if isinstance(error, NameError) else SubstitutionFailure
            raise kind(f"the expression '{shown(text)}' fails: {shown(reason, _SHOWN)}") from None

    def describe(self) -> str:
        """Return a description for people."""
        return (
            f"PythonExpr({described(self.expression)}, [{', '.join(each.describe() for each in self.python_modules)}])"
        )


class FileContent(Substitution):
    """Content of a text file.

    Args:
        path: Path of the file.
    """

    def __init__(self, path: SomeSubstitutionsType) -> None:
        self.path = normalize_to_list_of_substitutions(path)

    def perform(self, context: LaunchContext) -> str:
        """Return the content; raises SubstitutionFailure if it cannot be read."""
        path = perform_substitutions(context, self.path)
        try:
            return decoded(read_plain(Path(path), LONGEST)).replace("\r\n", "\n")
        except (OSError, ValueError) as error:
            reason = getattr(error, "strerror", None) or str(error)
            raise SubstitutionFailure(f"{shown(path)} cannot be read: {reason}") from None
