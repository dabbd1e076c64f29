"""Listing of what is announced on a domain: nodes, endpoints, and their names."""

from __future__ import annotations

from collections.abc import Sequence

from robolink.cli.shared.output import tell
from robolink.context import Context
from robolink.exceptions import WireError
from robolink.graph.graph import NamesAndTypes, Token, names_and_types
from robolink.wire import EndpointKind, EndpointToken, NodeToken, graph_pattern, parse_token


def announced(context: Context) -> dict[str, Token]:
    """Return the tokens announced on the context's domain, each by its text on the wire.

    The number of those that cannot be parsed is written to standard error.
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
    """Return the tokens announced on the context's domain."""
    return list(announced(context).values())


def nodes(context: Context) -> list[NodeToken]:
    """Return the tokens of the nodes."""
    return [token for token in tokens(context) if isinstance(token, NodeToken)]


def endpoints(context: Context, *kinds: EndpointKind) -> list[EndpointToken]:
    """Return the tokens of publishers, subscriptions, services and clients, or of some `kinds` only."""
    return [each for each in tokens(context) if isinstance(each, EndpointToken) and (not kinds or each.kind in kinds)]


def absolute(name: str) -> str:
    """Return a name with its leading slash: commands take names without it too."""
    return name if name.startswith("/") else f"/{name}"


def is_hidden(name: str) -> bool:
    """True if a part of the name begins with an underscore: such names are listed only on demand."""
    return any(part.startswith("_") for part in name.split("/"))


def sections_of(endpoints: Sequence[EndpointToken], hidden: bool) -> list[tuple[str, NamesAndTypes]]:
    """Return the six sections of `ros2 node info`: the title of each, with names and types."""
    from robolink.action.graph import actions

    of = {kind: names_and_types(each for each in endpoints if each.kind is kind) for kind in EndpointKind}
    titles = {
        "Subscribers": EndpointKind.SUBSCRIPTION,
        "Publishers": EndpointKind.PUBLISHER,
        "Service Servers": EndpointKind.SERVICE,
        "Service Clients": EndpointKind.CLIENT,
    }
    sections = [(title, of[kind]) for title, kind in titles.items()]
    sections += [
        ("Action Servers", actions(of[EndpointKind.SERVICE], of[EndpointKind.PUBLISHER])),
        ("Action Clients", actions(of[EndpointKind.CLIENT], of[EndpointKind.SUBSCRIPTION])),
    ]
    return [(title, [each for each in listed if hidden or not is_hidden(each[0])]) for title, listed in sections]
