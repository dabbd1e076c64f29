"""What is asked of a service or an action: its name, its type where that is said, and the message in YAML."""

from __future__ import annotations

import re
import sys
from typing import Any, NamedTuple

from robolink.cli.output import tell
from robolink.exceptions import RobolinkError

_TYPE = re.compile(r"[A-Za-z]\w*(?:[/.][A-Za-z]\w*){0,2}", re.ASCII)


class InputError(RobolinkError, ValueError):
    """There is no standard input to read, or it is no text."""


class Asked(NamedTuple):
    """What is called, or where a goal goes."""

    name: str
    """In full, with its leading slash."""
    type_: str
    """As it was named; empty where the graph shall say it."""
    values: str
    """The request or the goal in YAML."""


def is_type(text: str) -> bool:
    """Whether a text can name a type: then it is no YAML of a message."""
    return _TYPE.fullmatch(text) is not None


def read_stdin(what: str) -> str:
    """Read the `what`, "request" or "goal", that is piped in. Raises InputError for what is no text."""
    if sys.stdin is None:
        raise InputError("--stdin: there is no standard input")
    if sys.stdin.isatty():
        tell(f"the {what} in YAML, and Ctrl-D at its end:" if sys.platform != "win32" else f"the {what}, then Ctrl-Z:")
    try:
        return sys.stdin.read()
    except UnicodeDecodeError as error:
        raise InputError(f"--stdin: expected text in UTF-8: {error.reason} at byte {error.start}") from None


def message_of(msg_type: type[Any], values: str) -> Any:
    """Make the message of YAML. Raises DocumentError or EncodeError that say where it is wrong."""
    from robolink.message import encode, from_builtins
    from robolink.yamlfile import parse

    given = parse(values, name="<values>")
    message = from_builtins(msg_type, {} if given is None else given)
    encode(message)
    return message
