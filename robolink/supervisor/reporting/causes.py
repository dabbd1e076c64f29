"""Crash cause detection: finds in a program's output why it ended, such as the last line of a traceback."""

from __future__ import annotations

import re

from robolink.system.terminal import shown

_STALE = 25
"""Age in lines at which a possible cause is dropped: a program does not end because of older output."""
_LONGEST = 200
_COLOURS = re.compile(r"\x1b\[[0-9;]*m")
_GROUP = re.compile(r"^\s*[+|][ -]")
"""Prefix of the lines of an exception group."""
_FRAME = re.compile(r'^\s+File ".*", line \d+(, in .*)?$')
_HEADER = "Traceback (most recent call last):"
_CHAINS = (
    "The above exception was the direct cause of the following exception:",
    "During handling of the above exception, another exception occurred:",
)
_INTERRUPTED = "KeyboardInterrupt"
_FATAL = ("Fatal Python error: ", "terminate called ")
"""Beginnings of a fatal error of Python and of an uncaught exception of C++."""
_NOT_BEGUN = "Fatal Python error: init_"
"""Beginning of an error in Python's own start, before its program; a Ctrl-C at that time shows as any error."""
_OWN = "robolink: "
"""Prefix of an error by which a command of robolink ends."""


class Cause:
    """Line-by-line parser of a program's output; `text` is then the cause of its end, or empty.

    An error that follows from a Ctrl-C has that as its cause: in the middle of an import it may show as any error.
    """

    def __init__(self) -> None:
        self._found = ""
        self._age = 0
        self._is_in_traceback = self._is_led_to = False

    @property
    def text(self) -> str:
        """Cause on one line, for example `ZeroDivisionError: division by zero`."""
        return self._found if self._age <= _STALE else ""

    def line(self, line: bytes) -> None:
        """Parse a line."""
        self._age += 1
        text = line[: 4 * _LONGEST].decode(errors="replace").rstrip()
        if "\x1b" in text:
            text = _COLOURS.sub("", text)
        if self._is_in_traceback:
            self._traceback(text)
        elif text.endswith(_HEADER) or _FRAME.match(text):
            self._is_in_traceback = True
        elif text in _CHAINS:
            self._is_led_to = self._found == _INTERRUPTED
        elif text.startswith(_OWN):
            self._note(text.removeprefix(_OWN))
        elif text.startswith(_FATAL) or text == _INTERRUPTED:  # without a traceback, as early as that
            self._note(text)
        elif text.startswith("  what():"):
            self._note(text.partition(":")[2].strip())

    def _traceback(self, text: str) -> None:
        """Wait for the line that is not indented: the exception."""
        plain = _GROUP.sub("", text)
        if plain and not plain[0].isspace() and not plain.endswith(_HEADER):
            self._is_in_traceback = False
            self._note(plain)

    def _note(self, text: str) -> None:
        if self.text.startswith(_NOT_BEGUN) and text != _INTERRUPTED:
            return
        self._found, self._age = _INTERRUPTED if self._is_led_to else shown(text, _LONGEST), 0
        self._is_led_to = False
