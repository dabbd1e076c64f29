"""What is announced on a domain, as commands look at it: nodes, endpoints, and their names."""

from __future__ import annotations

from robolink.cli.output import tell
from robolink.context import Context
from robolink.exceptions import WireError
from robolink.graph import Token
from robolink.wire import EndpointKind, EndpointToken, NodeToken, graph_pattern, parse_token


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
