"""What commands that look at a running system share: a short-lived context, and the list of what is announced."""

from __future__ import annotations

import contextlib
import os
import sys
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from robolink.context import Context
from robolink.exceptions import WireError
from robolink.graph import Token
from robolink.signals import install_signal_handlers
from robolink.wire import EndpointKind, EndpointToken, NodeToken, graph_pattern, parse_token

if TYPE_CHECKING:
    from robolink.node import Node

_left: list[Context] = []
"""Contexts that a look has left behind, still open."""


@contextlib.contextmanager
def opened() -> Iterator[Context]:
    """A context that is ok inside the block, in which Ctrl-C is handled."""
    context = _initialized()
    try:
        yield context
    finally:
        context.try_shutdown()


@contextlib.contextmanager
def looking() -> Iterator[Context]:
    """A context for a command that only looks at what is announced, and ends then.

    It is left open: closing a session that has 30 peers takes 0.3 s, and nothing of it needs a farewell.
    """
    context = _initialized()
    _left.append(context)
    yield context


def close_looks() -> None:
    """Close what looks have left open: for a process that goes on."""
    while _left:
        _left.pop().try_shutdown()


def any_looks() -> bool:
    """Whether looks have left anything open."""
    return bool(_left)


def _initialized() -> Context:
    context = Context()
    context.init(args=[])
    install_signal_handlers()
    return context


def node_of(context: Context, name: str = "", *, describes: bool = False) -> Node:
    """Make the node that a command speaks through: hidden, unless it is given a name.

    It serves nothing, but where it `describes` it says what the types that it uses are made of, as every other node.
    """
    from robolink.node import Node
    from robolink.parameter import Parameter

    return Node(
        name or f"_robolink_cli_{os.getpid()}",
        context=context,
        enable_rosout=False,
        start_parameter_services=False,
        parameter_overrides=[Parameter("start_type_description_service", value=describes)],
    )


def announced(context: Context) -> dict[str, Token]:
    """Give what is announced on the context's domain, each by its text on the wire.

    How much of it cannot be read is told on standard error.
    """
    found, malformed = {}, 0
    for text in context.transport.tokens(graph_pattern(context.get_domain_id())):
        try:
            found[text] = parse_token(text)
        except WireError:
            malformed += 1
    if malformed:
        tell(f"robolink: {malformed} announcement{'s' if malformed > 1 else ''} could not be read")
    return found


def tokens(context: Context) -> list[Token]:
    """List what is announced on the context's domain."""
    return list(announced(context).values())


def nodes(context: Context) -> list[NodeToken]:
    """List the nodes."""
    return [token for token in tokens(context) if isinstance(token, NodeToken)]


def endpoints(context: Context, *kinds: EndpointKind) -> list[EndpointToken]:
    """List the publishers, subscriptions, services and clients, or those of some kinds."""
    return [each for each in tokens(context) if isinstance(each, EndpointToken) and (not kinds or each.kind in kinds)]


def absolute(name: str) -> str:
    """Give a name with its leading slash: commands take names without it too."""
    return name if name.startswith("/") else f"/{name}"


def is_hidden(name: str) -> bool:
    """Whether ros2 does not show this name unless asked: a part of it begins with an underscore."""
    return any(part.startswith("_") for part in name.split("/"))


def say(text: str) -> None:
    """Write a line to standard output, at once."""
    if sys.stdout is not None:  # it is None where it was closed from the start
        sys.stdout.write(text + "\n")
        sys.stdout.flush()


def say_json(value: Any) -> None:
    """Write a line of JSON to standard output."""
    import msgspec

    say(msgspec.json.encode(value).decode())


def tell(text: str) -> None:
    """Write a line for the person at the keyboard to standard error."""
    sys.stderr.write(text + "\n")
    sys.stderr.flush()
