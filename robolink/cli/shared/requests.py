"""Parsing of requests and goals on the command line: a name, an optional type, and a message in YAML."""

from __future__ import annotations

import re
import sys
from typing import Any, NamedTuple

from robolink.cli.shared.output import tell
from robolink.exceptions import RobolinkError

_TYPE = re.compile(r"[A-Za-z]\w*(?:[/.][A-Za-z]\w*){0,2}", re.ASCII)


class InputError(RobolinkError, ValueError):
    """Standard input is closed, or is not text."""


class GivenRequest(NamedTuple):
    """Request to a service, or goal for an action, as it was given on the command line."""

    name: str
    """Full name of the service or action, with its leading slash."""
    type_: str
    """Type as it was given; empty to take the one that the graph shows."""
    values: str
    """Request or goal in YAML."""


def is_type(text: str) -> bool:
    """True if a text can name a type: then it is not YAML of a message."""
    return _TYPE.fullmatch(text) is not None


def read_stdin(what: str) -> str:
    """Return standard input, which is a `what`: "request" or "goal". Raises InputError if it is not text."""
    if sys.stdin is None:
        raise InputError("--stdin: there is no standard input")
    if sys.stdin.isatty():
        tell(f"the {what} in YAML, and Ctrl-D at its end:" if sys.platform != "win32" else f"the {what}, then Ctrl-Z:")
    try:
        return sys.stdin.read()
    except UnicodeDecodeError as error:
        raise InputError(f"--stdin: expected text in UTF-8: {error.reason} at byte {error.start}") from None


def message_of(msg_type: type[Any], values: str) -> Any:
    """Return a message with the values in YAML. Raises DocumentError or EncodeError with the place of a mistake."""
    from robolink.documents.yamlfile import parse
    from robolink.message import encode, from_builtins

    given = parse(values, name="<values>")
    message = from_builtins(msg_type, {} if given is None else given)
    encode(message)
    return message
