"""Substitutions in texts of XML and YAML files, `$(var name)` (`launch.frontend`)."""

from __future__ import annotations

import re
import shlex
from collections.abc import Iterable, Sequence
from typing import Any, TypeAlias

from robolink.launch.ros.launch.bases import LaunchError, Substitution
from robolink.launch.ros.launch.frontend.expose import WrongNumberError, instantiate_substitution
from robolink.launch.ros.launch.typed_values import ScalarTypesTuple, ValueTypeError
from robolink.launch.ros.launch.utilities import TextSubstitution
from robolink.system.terminal import shown

__all__ = [
    "parse_if_substitutions",
    "parse_substitution",
]


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

    def text(self, end: str = "", quote: str = "", within: str = "") -> list[Substitution]:
        """Read up to one of the letters of `end`, or up to the closing `quote`; to the end of the text without.

        `within` is the quote around the substitution that it is in: other ones are letters like any other there.
        """
        found: list[Substitution] = []
        plain: list[str] = []
        while self._at < len(self._text):
            here = self._text[self._at]
            if self._text.startswith("$(", self._at):
                _flush(plain, found)
                found.append(self._substitution(quote or within))
            elif here == "\\" and self._escapes(end):
                plain.append(self._text[self._at + 1])
                self._at += 2
            elif within and here == within:
                raise SubstitutionSyntaxError(
                    f"{here} within {here}...{here}: write \\{here}, or the other quotes around"
                )
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

    def _substitution(self, within: str) -> Substitution:
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
            is_quote = here in "'\"" and not within
            arguments.append(self._quoted(here) if is_quote else self.text(end=")", within=within))
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
    try:
        return instantiate_substitution(arguments[0][0].text, arguments[1:])
    except WrongNumberError as error:
        raise SubstitutionSyntaxError(f"{error}: {shown(written, 60)}") from None


def parse_if_substitutions(value: Any) -> Any:
    """Return a value with the substitutions in it: a text that has none, and a number, as they are.

    Args:
        value: A scalar, or a list of them.

    Raises:
        ValueTypeError: for a list with numbers of several types.
    """
    if isinstance(value, list):
        found = [parse_if_substitutions(each) for each in value]
        plain = [each for each in found if isinstance(each, ScalarTypesTuple)]
        if len({type(each) for each in plain}) > 1:
            raise ValueTypeError(f"expected a list of one type, got {value!r:.60}")
        return found
    if not isinstance(value, str) or not value:
        return value
    parts = parse_substitution(value)
    return parts[0].text if len(parts) == 1 and isinstance(parts[0], TextSubstitution) else parts


def words_of(parts: Iterable[Substitution]) -> list[list[Substitution]]:
    """Return the words of a command line: texts are split as a shell does, and a substitution is in one word.

    Args:
        parts: The command line, its texts and substitutions.

    Raises:
        SubstitutionSyntaxError: for a quote that is not closed within its text.
    """
    words: list[list[Substitution]] = [[]]
    for part in parts:
        if not isinstance(part, TextSubstitution):
            words[-1].append(part)
            continue
        try:
            pieces = shlex.split(part.text)
        except ValueError as error:
            reason = "ROS 2 splits the text at each substitution, so that quotes around one do not close"
            raise SubstitutionSyntaxError(f"{error}: {reason}") from None
        if part.text[:1].isspace():
            words.append([])
        for number, piece in enumerate(pieces):
            words += [[]] if number else []
            words[-1].append(TextSubstitution(text=piece))
        if part.text[-1:].isspace():
            words.append([])
    return [each for each in words if each]
