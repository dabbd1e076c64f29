"""Substitutions: texts that are known only when the launch runs (`launch.substitutions`)."""

from __future__ import annotations

import importlib
import importlib.util
import itertools
import math
import os
import re
import shutil
import subprocess
import sys
import threading
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import IO, Any

from robolink.exceptions import nearest
from robolink.launch.ros.launch.bases import LaunchContext, LaunchError, SomeSubstitutionsType, Substitution, described
from robolink.launch.ros.launch.utilities import (
    FALSE,
    TRUE,
    TextSubstitution,
    boolean,
    is_substitution,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)
from robolink.system import waits
from robolink.system.files import decoded, read_plain
from robolink.system.processes import split_words
from robolink.system.terminal import shown

__all__ = [
    "AllSubstitution",
    "AndSubstitution",
    "AnonName",
    "AnySubstitution",
    "Command",
    "EnvironmentVariable",
    "EqualsSubstitution",
    "FileContent",
    "FindExecutable",
    "ForEachVar",
    "ForLoopIndex",
    "IfElseSubstitution",
    "LaunchConfiguration",
    "LaunchLogDir",
    "LocalSubstitution",
    "NotEqualsSubstitution",
    "NotSubstitution",
    "OrSubstitution",
    "PathJoinSubstitution",
    "PathSubstitution",
    "PythonExpression",
    "StringJoinSubstitution",
    "SubstitutionFailure",
    "TextSubstitution",
    "ThisLaunchFile",
    "ThisLaunchFileDir",
]


class SubstitutionFailure(LaunchError):  # noqa: N818 - ROS 2's name
    """A substitution has no value; the text has the reason."""


class ExpressionNameError(SubstitutionFailure, NameError):
    """An expression has a name that is not there: one of a module, say, that it does not have."""


_STEP = re.compile(r"\.?(\w+)|\[\s*(?:'([^']*)'|\"([^\"]*)\"|(\d+))\s*\]")
_numbers = itertools.count(1)


class LaunchConfiguration(Substitution):
    """Value of a launch argument, or of what SetLaunchConfiguration has set.

    Args:
        variable_name: Name of the configuration.
        default: Value where it is not set; without one that is an error.
    """

    def __init__(self, variable_name: SomeSubstitutionsType, *, default: Any = None) -> None:
        self.variable_name = normalize_to_list_of_substitutions(variable_name)
        self.default = None if default is None else _plain(default)

    def perform(self, context: LaunchContext) -> str:
        """Return the value; raises SubstitutionFailure if it is not set."""
        name, known = perform_substitutions(context, self.variable_name), context.launch_configurations
        context.requested.add(name)
        if name in known:
            return str(known[name])
        if self.default is None:
            own = [each for each in known if each not in ("ros_remaps", "global_params")]
            hint = nearest(name, own) or (f": there is {', '.join(own[:8])}" if own else "")
            raise SubstitutionFailure(f"no launch argument is called '{shown(name)}'{hint}")
        return perform_substitutions(context, self.default)

    def describe(self) -> str:
        """Return a description for people."""
        return f"LaunchConfig({described(self.variable_name)})"


class EnvironmentVariable(Substitution):
    """Value of an environment variable.

    Args:
        name: Name of the variable.
        default_value: Value where it is not set; without one that is an error.
    """

    def __init__(self, name: SomeSubstitutionsType, *, default_value: SomeSubstitutionsType | None = None) -> None:
        self.name = normalize_to_list_of_substitutions(name)
        self.default_value = None if default_value is None else normalize_to_list_of_substitutions(default_value)

    def perform(self, context: LaunchContext) -> str:
        """Return the value; raises SubstitutionFailure if it is not set."""
        name = perform_substitutions(context, self.name)
        if name in context.environment:
            return context.environment[name]
        if self.default_value is None:
            raise SubstitutionFailure(f"the environment has no '{shown(name)}'{nearest(name, context.environment)}")
        return perform_substitutions(context, self.default_value)

    def describe(self) -> str:
        """Return a description for people."""
        return f"EnvVar({described(self.name)})"


class LocalSubstitution(Substitution):
    """Value of one of the context's locals, such as `event.returncode`.

    Args:
        expression: Name, with attributes and keys behind it.
        description: Description for people.
    """

    def __init__(self, expression: str, description: str | None = None) -> None:
        self.expression, self.description = expression, description

    def perform(self, context: LaunchContext) -> str:
        """Return the value; raises SubstitutionFailure if there is none."""
        value: Any = context.get_locals_as_dict()
        at = 0
        while at < len(self.expression):
            step = _STEP.match(self.expression, at)
            if step is None:
                raise SubstitutionFailure(f"'{self.expression}' is not a name with attributes and keys")
            at, name = step.end(), next(each for each in step.groups() if each is not None)
            try:
                value = (
                    value[int(name)] if step[4] else value[name] if isinstance(value, dict) else getattr(value, name)
                )
            except (LookupError, AttributeError):
                raise SubstitutionFailure(f"the context has no '{self.expression}' here ({name})") from None
        return str(value)


FOR_EACH = "ForEachVar__"
"""Beginning of the names of those locals that an iteration of ForEach has."""


class ForEachVar(Substitution):
    """Value that an iteration of a ForEach of XML or YAML has.

    Args:
        name: Name of the value.
        default_value: Value of an iteration that has none of this name; without one that is an error.
    """

    def __init__(self, name: SomeSubstitutionsType, *, default_value: SomeSubstitutionsType | None = None) -> None:
        self.name = normalize_to_list_of_substitutions(name)
        self.default_value = None if default_value is None else normalize_to_list_of_substitutions(default_value)

    def perform(self, context: LaunchContext) -> str:
        """Return the value; raises SubstitutionFailure if there is none."""
        name, known = perform_substitutions(context, self.name), context.get_locals_as_dict()
        if FOR_EACH + name in known:
            return str(known[FOR_EACH + name])
        if self.default_value is None:
            own = [each.removeprefix(FOR_EACH) for each in known if each.startswith(FOR_EACH)]
            hint = nearest(name, own) or (f": there is {', '.join(own[:8])}" if own else "")
            raise SubstitutionFailure(f"no loop here has the value '{shown(name)}'{hint}")
        return perform_substitutions(context, self.default_value)


class ForLoopIndex(ForEachVar):
    """Number that an iteration of a ForLoop of XML or YAML has.

    Args:
        name: Name of the loop.
    """

    def __init__(self, name: SomeSubstitutionsType) -> None:
        super().__init__(name)


class PathJoinSubstitution(Substitution):
    """Path of several parts; `/` adds another one.

    Args:
        substitutions: The parts; one that is a list is joined to a single part.
    """

    def __init__(self, substitutions: Iterable[SomeSubstitutionsType]) -> None:
        self.substitutions = [normalize_to_list_of_substitutions(each) for each in substitutions]

    def perform(self, context: LaunchContext) -> str:
        """Return the path."""
        parts = [perform_substitutions(context, each) for each in self.substitutions]
        return os.path.join(*parts) if parts else ""  # noqa: PTH118 - it is a text, whose slashes stay as they are

    def __truediv__(self, part: SomeSubstitutionsType) -> PathJoinSubstitution:
        """Return the path with one more `part`."""
        return PathJoinSubstitution([*self.substitutions, part])


class PathSubstitution(PathJoinSubstitution):
    """Path to which `/` adds parts.

    Args:
        path: Its beginning.
    """

    def __init__(self, path: SomeSubstitutionsType) -> None:
        super().__init__([path])


class StringJoinSubstitution(Substitution):
    """Texts with a delimiter between them.

    Args:
        substitutions: The texts; one that is a list is joined first.
        delimiter: Text between them.
    """

    def __init__(self, substitutions: Iterable[SomeSubstitutionsType], delimiter: SomeSubstitutionsType = "") -> None:
        self.substitutions = [normalize_to_list_of_substitutions(each) for each in substitutions]
        self.delimiter = normalize_to_list_of_substitutions(delimiter)

    def perform(self, context: LaunchContext) -> str:
        """Return the joined text."""
        parts = [perform_substitutions(context, each) for each in self.substitutions]
        return perform_substitutions(context, self.delimiter).join(parts)


class ThisLaunchFile(Substitution):
    """Path of the launch file in which this stands."""

    def perform(self, context: LaunchContext) -> str:
        """Return the path."""
        return _of_file(context, "current_launch_file_path")


class ThisLaunchFileDir(Substitution):
    """Folder of the launch file in which this stands."""

    def perform(self, context: LaunchContext) -> str:
        """Return the folder."""
        return _of_file(context, "current_launch_file_directory")

    def __truediv__(self, part: SomeSubstitutionsType) -> PathJoinSubstitution:
        """Return the path with one more `part`."""
        return PathJoinSubstitution([self, part])


class LaunchLogDir(Substitution):
    """Folder of the logs: `ROS_LOG_DIR`, or that of robolink's launcher, in which each run has a folder of its own."""

    def perform(self, context: LaunchContext) -> str:
        """Return the folder."""
        named = context.environment.get("ROBOLINK_LOG_DIR") or context.environment.get("ROS_LOG_DIR")
        return named or str(Path("~/.robolink/log").expanduser())


class AnonName(Substitution):
    """Name that no other process has, on this machine or another: the same one for the same name in a launch.

    Args:
        name: Its beginning.
    """

    def __init__(self, name: SomeSubstitutionsType) -> None:
        self.name = normalize_to_list_of_substitutions(name)

    def perform(self, context: LaunchContext) -> str:
        """Return the name."""
        key = f"anon{perform_substitutions(context, self.name)}"
        if key not in context.launch_configurations:
            import socket

            base = re.sub(r"\W", "_", f"{key.removeprefix('anon')}_{socket.gethostname()}", flags=re.ASCII)
            context.launch_configurations[key] = f"{base}_{os.getpid()}_{next(_numbers)}"
        return str(context.launch_configurations[key])


def _of_file(context: LaunchContext, name: str) -> str:
    values = context.get_locals_as_dict()
    if name not in values:
        raise SubstitutionFailure("there is no launch file here: the description was made by a program")
    return str(values[name])


def _plain(value: Any) -> list[Substitution]:
    """Return the list for a default, which may be a plain value or a list of these."""
    if is_substitution(value) or isinstance(value, (str, os.PathLike)):
        return normalize_to_list_of_substitutions(value)
    if isinstance(value, Iterable):
        return [each for part in value for each in _plain(part)]
    return normalize_to_list_of_substitutions(str(value))


class NotSubstitution(Substitution):
    """The opposite of a boolean.

    Args:
        value: Text that spells a boolean.
    """

    def __init__(self, value: SomeSubstitutionsType) -> None:
        self.value = normalize_to_list_of_substitutions(value)

    def perform(self, context: LaunchContext) -> str:
        """Return true or false."""
        return _spelled(not _truth(context, self.value))


class AllSubstitution(Substitution):
    """True if all booleans are, also if there is none.

    Args:
        *args: Texts that spell booleans.
    """

    def __init__(self, *args: SomeSubstitutionsType) -> None:
        self.args = [normalize_to_list_of_substitutions(each) for each in args]

    def perform(self, context: LaunchContext) -> str:
        """Return true or false."""
        return _spelled(all(self._truths(context)))

    def _truths(self, context: LaunchContext) -> list[bool]:
        """Return all the booleans: each text must spell one, wherever it stands."""
        return [_truth(context, each) for each in self.args]


class AnySubstitution(AllSubstitution):
    """True if one of the booleans is; false if there is none."""

    def perform(self, context: LaunchContext) -> str:
        """Return true or false."""
        return _spelled(any(self._truths(context)))


class AndSubstitution(AllSubstitution):
    """True if both booleans are.

    Args:
        left, right: Texts that spell booleans.
    """

    def __init__(self, left: SomeSubstitutionsType, right: SomeSubstitutionsType) -> None:
        super().__init__(left, right)
        self.left, self.right = self.args


class OrSubstitution(AnySubstitution):
    """True if one of two booleans is.

    Args:
        left, right: Texts that spell booleans.
    """

    def __init__(self, left: SomeSubstitutionsType, right: SomeSubstitutionsType) -> None:
        super().__init__(left, right)
        self.left, self.right = self.args


class EqualsSubstitution(Substitution):
    """True if two values are the same: as booleans if both spell one, as numbers if both are, else as texts.

    Args:
        left, right: Texts, substitutions or plain values.
    """

    def __init__(self, left: Any, right: Any) -> None:
        self.left, self.right = _as_list(left), _as_list(right)

    def perform(self, context: LaunchContext) -> str:
        """Return true or false."""
        return _spelled(self._are_equal(context))

    def _are_equal(self, context: LaunchContext) -> bool:
        left, right = (perform_substitutions(context, each) for each in (self.left, self.right))
        if {left.lower(), right.lower()} <= {*TRUE, *FALSE}:
            return (left.lower() in TRUE) == (right.lower() in TRUE)
        try:
            return math.isclose(float(left), float(right))
        except ValueError:
            return left == right


class NotEqualsSubstitution(EqualsSubstitution):
    """True if two values differ."""

    def perform(self, context: LaunchContext) -> str:
        """Return true or false."""
        return _spelled(not self._are_equal(context))


class IfElseSubstitution(Substitution):
    """One of two texts.

    Args:
        condition: Text that spells a boolean.
        if_value: Text where it is true.
        else_value: Text where it is false.
    """

    def __init__(
        self,
        condition: SomeSubstitutionsType,
        if_value: SomeSubstitutionsType = "",
        else_value: SomeSubstitutionsType = "",
    ) -> None:
        if if_value == else_value == "":
            raise SubstitutionFailure("IfElseSubstitution needs an if_value or an else_value")
        self.condition, self.if_value, self.else_value = map(
            normalize_to_list_of_substitutions, (condition, if_value, else_value)
        )

    def perform(self, context: LaunchContext) -> str:
        """Return the text that counts."""
        return perform_substitutions(context, self.if_value if _truth(context, self.condition) else self.else_value)


def _truth(context: LaunchContext, subs: SomeSubstitutionsType) -> bool:
    """Return the boolean that the text of `subs` spells. Raises SubstitutionFailure."""
    try:
        return boolean(context, subs)
    except LaunchError as error:
        raise SubstitutionFailure(str(error)) from None


def _spelled(value: bool) -> str:
    return "true" if value else "false"


def _as_list(value: Any) -> list[Substitution]:
    if is_substitution(value):
        return normalize_to_list_of_substitutions(value)
    text = "" if value is None else _spelled(value) if isinstance(value, bool) else str(value)
    return normalize_to_list_of_substitutions(text)


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
