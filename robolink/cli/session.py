"""What commands that look at a running system share: a short-lived context, and the list of what is announced."""

from __future__ import annotations

import contextlib
import os
import sys
from collections.abc import Iterator
from typing import TYPE_CHECKING

from robolink.context import Context
from robolink.exceptions import WireError
from robolink.graph import Token
from robolink.signals import install_signal_handlers
from robolink.wire import EndpointToken, NodeToken, graph_pattern, parse_token

if TYPE_CHECKING:
    from robolink.node import Node


@contextlib.contextmanager
def opened() -> Iterator[Context]:
    """A context that is ok inside the block, in which Ctrl-C is handled."""
    context = Context()
    context.init(args=[])
    install_signal_handlers()
    try:
        yield context
    finally:
        context.try_shutdown()


def node_of(context: Context) -> Node:
    """Make the hidden node that a command speaks through."""
    from robolink.node import Node

    return Node(f"_robolink_cli_{os.getpid()}", context=context, enable_rosout=False, start_parameter_services=False)


def tokens(context: Context) -> list[Token]:
    """List what is announced on the context's domain; what cannot be read is left out."""
    found = []
    for text in context.transport.tokens(graph_pattern(context.get_domain_id())):
        with contextlib.suppress(WireError):
            found.append(parse_token(text))
    return found


def nodes(context: Context) -> list[NodeToken]:
    """List the nodes."""
    return [token for token in tokens(context) if isinstance(token, NodeToken)]


def endpoints(context: Context) -> list[EndpointToken]:
    """List the publishers, subscriptions, services and clients."""
    return [token for token in tokens(context) if isinstance(token, EndpointToken)]


def is_hidden(name: str) -> bool:
    """Whether ros2 does not show this name unless asked: a part of it begins with an underscore."""
    return any(part.startswith("_") for part in name.split("/"))


def say(text: str) -> None:
    """Write a line to standard output, at once."""
    if sys.stdout is not None:  # it is None where it was closed from the start
        sys.stdout.write(text + "\n")
        sys.stdout.flush()


def tell(text: str) -> None:
    """Write a line for the person at the keyboard to standard error."""
    sys.stderr.write(text + "\n")
    sys.stderr.flush()
