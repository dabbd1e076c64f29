"""Output of `robolink service info`: a service's type, its servers and its clients."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from robolink.cli.shared.graph import absolute, announced
from robolink.cli.shared.output import say, say_json
from robolink.cli.shared.session import looking
from robolink.exceptions import NotFoundError
from robolink.system.terminal import shown
from robolink.topic_endpoint_info import qos_lines
from robolink.wire import EndpointKind, EndpointToken, gid_of

if TYPE_CHECKING:
    from robolink.graph.graph import Token

TITLES = {EndpointKind.CLIENT: "Clients count", EndpointKind.SERVICE: "Services count"}
ROLES = {EndpointKind.CLIENT: "CLIENT", EndpointKind.SERVICE: "SERVER"}


class End(NamedTuple):
    """A server or client, and its gid."""

    token: EndpointToken
    gid: str


def show(service: str, *, verbose: bool, as_json: bool) -> None:
    """Show the service. Raises NotFoundError for one that has neither servers nor clients."""
    with looking() as context:
        tokens = announced(context)
    ends = _ends(tokens, absolute(service), f"domain {context.get_domain_id()}")
    types = sorted({each.token.type_name for each in ends})
    if as_json:
        say_json({"name": absolute(service), "types": types, **_as_json(ends)})
        return
    more = "\n" if verbose else ""
    say(f"Type: {types[0] if len(types) == 1 else types}{more}")
    for kind, title in TITLES.items():
        of_kind = [each for each in ends if each.token.kind is kind]
        say(f"{title}: {len(of_kind)}{more}")
        for each in of_kind if verbose else ():
            say(f"{described(each)}\n")


def _ends(tokens: dict[str, Token], name: str, where: str) -> list[End]:
    found = [
        End(each, ".".join(f"{byte:02x}" for byte in gid_of(text)))
        for text, each in tokens.items()
        if isinstance(each, EndpointToken) and each.kind in TITLES
    ]
    ends = [each for each in found if each.token.name == name]
    if not ends:
        raise NotFoundError("service", shown(name), {each.token.name for each in found}, where)
    return sorted(ends, key=lambda each: (each.token.full_node_name, each.gid))


def described(end: End) -> str:
    """Return the lines that ros2 prints for an endpoint."""
    token = end.token
    return "\n".join(
        [
            f"Node name: {token.node_name}",
            f"Node namespace: {token.namespace}",
            f"Service type: {token.type_name}",
            f"Service type hash: {token.type_hash}",
            f"Endpoint type: {ROLES[token.kind]}",
            f"GID: {end.gid}",
            *qos_lines(token.qos),
        ]
    )


def _as_json(ends: list[End]) -> dict[str, list[dict[str, str]]]:
    return {
        f"{role.lower()}s": [
            {"node": token.full_node_name, "type": token.type_name, "hash": token.type_hash, "gid": gid}
            for token, gid in ends
            if token.kind is kind
        ]
        for kind, role in ROLES.items()
    }
