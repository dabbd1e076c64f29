r"""Texts for people at a terminal: untrusted text made safe to print, without control sequences; colours; the browser.

Characters that move the cursor, colour, ring, or change the text's direction become escape sequences that Python,
YAML (in double quotes) and JSON (but for ``\x1b``, which JSON's writers never leave) read back as the same character.
"""

from __future__ import annotations

import functools
import os
import re
import sys
from typing import TextIO

_UNFIT = "\x00-\x08\x0b-\x1f\x7f-\x9f\u061c\u200e\u200f\u2028-\u202e\u2066-\u206f\ud800-\udfff"
"""Unsafe characters: C0 without tab and line feed, DEL, C1, text direction, line separators, lone surrogates."""

_OF_LINES = f"[{_UNFIT}]"
_OF_A_LINE = f"[\t\n{_UNFIT}]"
_BUT_COLOURS = rf"(\x1b\[[0-9;:]{{0,40}}m)|[{_UNFIT}]"


@functools.cache
def _compiled(pattern: str) -> re.Pattern[str]:  # on first use: it takes longer than the rest of this file
    return re.compile(pattern)


_SHORT = {"\t": "\\t", "\n": "\\n", "\r": "\\r"}


def fit(text: str, *, lines: bool = True, colours: bool = False) -> str:
    r"""Return `text` with escapes in place of control characters, safe for a terminal.

    With `lines`, tabs and line feeds stay; without, it is one line. With `colours`, colour sequences (SGR) stay too.
    Safe text stays as it is, so that nothing is lost by doing it twice.

    >>> fit("a\x1b[2Jb")
    'a\\x1b[2Jb'
    """
    if colours:
        return _compiled(_BUT_COLOURS).sub(lambda match: match[1] or escaped(match[0]), text)
    return _compiled(_OF_LINES if lines else _OF_A_LINE).sub(lambda match: escaped(match[0]), text)


def wants_colour(output: TextIO | None) -> bool:
    """True if colours make sense in this `output`: it is a terminal that knows them, and NO_COLOR is not set."""
    return output is not None and not os.environ.get("NO_COLOR") and output.isatty() and knows_colours()


def knows_colours() -> bool:
    """True if this process's terminal knows escape sequences; switches them on first in Windows' console."""
    return _escapes_switched_on() if sys.platform == "win32" else os.environ.get("TERM") != "dumb"


@functools.cache
def _escapes_switched_on() -> bool:
    """Switch on escape sequences of Windows' console, which an empty command does; once, since it takes a while."""
    return os.system("") == 0


def styled(text: str, style: str, output: TextIO | None) -> str:
    """Return `text` in a style where an output wants colours, and as it is elsewhere.

    Args:
        text: The text.
        style: Numbers of an SGR sequence, such as "1;31" for bold red; '' for none.
        output: Where it is written.
    """
    return f"\x1b[{style}m{text}\x1b[0m" if text and style and wants_colour(output) else text


def is_fit(text: str) -> bool:
    """True if `fit` leaves these lines as they are."""
    return _compiled(_OF_LINES).search(text) is None


def shown(text: str, longest: int = 100) -> str:
    """Return `text` for an error message: on one line, visible characters only, at most `longest` of them."""
    part = text if len(text) <= longest else text[: longest - 3] + "..."
    return part if part.isprintable() else "".join(each if each.isprintable() else escaped(each) for each in part)


def quoted(text: str, *, also: str = "") -> str:
    r"""Return `text` in double quotes, with escapes that Python, YAML and rosidl read back; `also` of these characters.

    >>> print(quoted('say "hi"\n'))
    "say \"hi\"\n"
    """
    plain = (
        f"\\{each}" if each in '"\\' else each if each.isprintable() and each not in also else escaped(each)
        for each in text
    )
    return f'"{"".join(plain)}"'


def escaped(char: str) -> str:
    r"""Return the escape sequence of one character: ``\n``, ``\x1b``, ``\u202e``, ``\U000e0001``."""
    code = ord(char)
    if code < 0x7F:
        return _SHORT.get(char) or f"\\x{code:02x}"
    return f"\\u{code:04x}" if code <= 0xFFFF else f"\\U{code:08x}"


def with_article(noun: str) -> str:
    """Return a noun with its indefinite article, as one writes it of a type's name.

    >>> with_article("int32"), with_article("uint8")
    ('an int32', 'a uint8')
    """
    return f"a{'n' if noun[:1] in tuple('aeio') else ''} {noun}"


def open_in_browser(address: str) -> bool:
    """Open an address in the browser; False where there is no screen, or no browser."""
    import webbrowser

    return has_screen() and webbrowser.open(address)


def has_screen() -> bool:
    """True if a browser that is opened here is seen by who sits at the terminal."""
    is_on_desktop = "SSH_CONNECTION" not in os.environ
    has_server = bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))
    return is_on_desktop if sys.platform in ("win32", "darwin") else has_server


def ssh_tunnel(port: int) -> str:
    """Return the command that brings a port to the computer from which somebody came here by ssh; '' if nobody did."""
    _, _, host, ssh_port = (*os.environ.get("SSH_CONNECTION", "").split(), "", "", "", "")[:4]
    if not host:
        return ""
    user = os.environ.get("USER") or os.environ.get("LOGNAME")
    at = f"{shown(user)}@{shown(host)}" if user else shown(host)
    return f"ssh -L {port}:localhost:{port} {f'-p {shown(ssh_port)} ' if ssh_port != '22' else ''}{at}"
