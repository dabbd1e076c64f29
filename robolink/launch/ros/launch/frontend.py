"""Substitutions in texts of XML and YAML files, `$(var name)` (`launch.frontend`)."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from typing import Any, TypeAlias, TypeVar

from robolink.exceptions import nearest
from robolink.launch.ros.launch.bases import LaunchError, Substitution
from robolink.launch.ros.launch.utilities import TextSubstitution
from robolink.system.terminal import shown

__all__ = [
    "expose_action",
    "expose_substitution",
    "parse_substitution",
]


T = TypeVar("T")


def expose_action(name: str) -> Callable[[T], T]:
    """Return a decorator without effect: one's own actions are for files in Python, not for the tag `name`."""
    return lambda cls: cls


def expose_substitution(name: str) -> Callable[[T], T]:
    """Return a decorator without effect: substitutions of one's own are not for `name` in XML and YAML."""
    return lambda cls: cls


_ESCAPE = re.compile(r"\\(.)")
DEEPEST = 50
"""Deepest nesting of substitutions."""
Argument: TypeAlias = "list[Substitution]"


class SubstitutionSyntaxError(LaunchError, ValueError):
    """A text has a substitution that is not closed, not known, or has the wrong arguments."""


def parse_substitution(string: str) -> list[Substitution]:
    """Return a text with `$(...)` in it, `string`, as a list of substitutions. Raises SubstitutionSyntaxError."""
    if "$(" not in string and "\\" not in string:
        return [TextSubstitution(text=string)]
    return _Reader(string).text()


def unescaped(text: str) -> str:
    """Return a `text` without its backslashes: each stands for the letter behind it."""
    return _ESCAPE.sub(r"\1", text)


class _Reader:
    """Recursive-descent parser of one text."""

    def __init__(self, text: str) -> None:
        self._text, self._at, self._depth = text, 0, 0

    def text(self, end: str = "", quote: str = "") -> list[Substitution]:
        """Read up to one of the letters of `end`, or up to the closing `quote`; to the end of the text without."""
        found: list[Substitution] = []
        plain: list[str] = []
        while self._at < len(self._text):
            here = self._text[self._at]
            if self._text.startswith("$(", self._at):
                _flush(plain, found)
                found.append(self._substitution())
            elif here == "\\" and self._escapes(end):
                plain.append(self._text[self._at + 1])
                self._at += 2
            elif here == quote or here in end or (end and here.isspace()):
                break
            else:
                plain.append(here)
                self._at += 1
        _flush(plain, found)
        return found

    def _escapes(self, end: str) -> bool:
        """True if the backslash here stands before a letter; without quotes a blank ends an argument in any case."""
        after = self._text[self._at + 1 : self._at + 2]
        return after not in ("", "\n") and not (end and after.isspace())

    def _substitution(self) -> Substitution:
        begin, self._at = self._at, self._at + 2
        self._depth += 1
        if self._depth > DEEPEST:
            raise SubstitutionSyntaxError(f"substitutions are nested over {DEEPEST} deep")
        arguments: list[Argument] = []
        while True:
            self._skip_blanks()
            if self._at >= len(self._text):
                raise SubstitutionSyntaxError(f"'{shown(self._text[begin:], 60)}' has no closing bracket")
            here = self._text[self._at]
            if here == ")":
                break
            arguments.append(self._quoted(here) if here in "'\"" else self.text(end=")"))
        self._at += 1
        self._depth -= 1
        return _made(arguments, self._text[begin : self._at])

    def _quoted(self, quote: str) -> Argument:
        begin, self._at = self._at, self._at + 1
        found = self.text(quote=quote)
        if self._text[self._at : self._at + 1] != quote:
            raise SubstitutionSyntaxError(f"'{shown(self._text[begin:], 60)}' has no closing quote")
        self._at += 1
        return found or [TextSubstitution(text="")]

    def _skip_blanks(self) -> None:
        while self._at < len(self._text) and self._text[self._at].isspace():
            self._at += 1


def _flush(plain: list[str], found: list[Substitution]) -> None:
    if plain:
        found.append(TextSubstitution(text="".join(plain)))
        plain.clear()


def _made(arguments: Sequence[Argument], written: str) -> Substitution:
    """Return the substitution that a name with arguments stands for."""
    if not arguments or len(arguments[0]) != 1 or not isinstance(arguments[0][0], TextSubstitution):
        raise SubstitutionSyntaxError(f"'{shown(written, 60)}' names no substitution")
    name, given = arguments[0][0].text, arguments[1:]
    makers = _makers()
    if name in _OF_ROS_1:
        raise SubstitutionSyntaxError(f"$({name} ...) is ROS 1: $({_OF_ROS_1[name]} ...) is what ROS 2 has")
    if name not in makers:
        raise SubstitutionSyntaxError(f"no substitution is called '{shown(name)}'{nearest(name, makers)}")
    least, most, maker = makers[name]
    if not least <= len(given) <= most:
        number = str(least) if least == most else f"{least} to {most}" if most < MANY else f"{least} or more"
        raise SubstitutionSyntaxError(f"$({name} ...) takes {number} arguments, got {len(given)}: {shown(written, 60)}")
    made: Substitution = maker(*given)
    return made


_OF_ROS_1 = {"arg": "var", "find": "find-pkg-share", "optenv": "env"}
MANY = 1000
"""Upper bound of the arguments of those substitutions that take any number."""


def _makers() -> dict[str, tuple[int, int, Callable[..., Any]]]:
    """Return the substitutions by name: least and most arguments, and what makes one of them."""
    from robolink.launch.ros.launch import substitutions as own
    from robolink.launch.ros.launch_ros import substitutions as ros

    def joined(parts: Sequence[Argument]) -> Argument:
        blank = TextSubstitution(text=" ")
        return [each for index, part in enumerate(parts) for each in ([blank, *part] if index else part)]

    return {
        "var": (1, 2, lambda name, default=None: own.LaunchConfiguration(name, default=default)),
        "env": (1, 2, lambda name, default=None: own.EnvironmentVariable(name, default_value=default)),
        "find-pkg-share": (1, 1, ros.FindPackageShare),
        "find-pkg-prefix": (1, 1, ros.FindPackagePrefix),
        "exec-in-pkg": (2, 2, ros.ExecutableInPackage),
        "param": (1, 2, lambda name, default=None: ros.Parameter(name, default=default)),
        "find-exec": (1, 1, lambda name: own.FindExecutable(name=name)),
        "dirname": (0, 0, own.ThisLaunchFileDir),
        "filename": (0, 0, own.ThisLaunchFile),
        "launch_log_dir": (0, 0, own.LaunchLogDir),
        "log_dir": (0, 0, own.LaunchLogDir),
        "anon": (1, 1, own.AnonName),
        "eval": (1, MANY, lambda *parts: own.PythonExpression(joined(parts))),
        "command": (1, 2, _command),
        "file-content": (1, 1, own.FileContent),
        "not": (1, 1, own.NotSubstitution),
        "and": (2, 2, own.AndSubstitution),
        "or": (2, 2, own.OrSubstitution),
        "any": (0, MANY, own.AnySubstitution),
        "all": (0, MANY, own.AllSubstitution),
        "equals": (2, 2, own.EqualsSubstitution),
        "not-equals": (2, 2, own.NotEqualsSubstitution),
        "if": (2, 3, own.IfElseSubstitution),
        "join": (0, MANY, lambda *parts: own.StringJoinSubstitution(parts)),
        "path-join": (1, MANY, lambda *parts: own.PathJoinSubstitution(parts)),
    }


def _command(command: Argument, on_stderr: Argument | None = None) -> Substitution:
    from robolink.launch.ros.launch.substitutions import Command

    return Command(command) if on_stderr is None else Command(command, on_stderr=on_stderr)
