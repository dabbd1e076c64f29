"""Sides of a mirror: a transport each, and what is announced there in the names of the other side's nodes."""

from __future__ import annotations

import contextlib
import functools
import itertools
import secrets
from collections.abc import Callable
from typing import NamedTuple

from robolink.dds.mirror.lanes import Lane
from robolink.transport.base import Handle, Transport
from robolink.wire import (
    GID_BYTES,
    DataKey,
    EndpointToken,
    NodeToken,
    format_key,
    format_token,
    gid_of,
    own_tokens,
    sender_part,
)


class Announced(NamedTuple):
    """Announcement, on one side, of something that the other side has."""

    token: NodeToken | EndpointToken
    gid: bytes
    handle: Handle

    @property
    def sender(self) -> bytes:
        """End of the attachments that are sent in its name: the gid's length, and the gid."""
        return sender_part(self.gid)


class Side:
    """One of the two transports of a mirror.

    Args:
        transport: Session on this side's network; the caller closes it.
        domain: ROS domain id.
    """

    def __init__(self, transport: Transport, domain: int) -> None:
        self.transport, self.domain = transport, domain
        self.own_prefix = own_tokens(domain, transport.session_id)
        """Beginning of the tokens that the mirror announces here: they are not mirrored back."""
        self.lane = Lane(transport)
        """Lane of what this side's transport brings."""
        self.own: set[bytes] = set()
        """Gids of what the mirror announces here: what bears one of them is its own echo."""
        self.nobody = secrets.token_bytes(GID_BYTES)
        """Gid in the name of which callers without a token call here."""
        self.sender_of_nobody = sender_part(self.nobody)
        self.own.add(self.nobody)
        self._ids = itertools.count(1)
        self._node_ids: dict[tuple[str, str], tuple[str, int]] = {}
        """Id of each node of the other side here, and the number of announcements that use it; by session and id."""

    def announce(self, token: NodeToken | EndpointToken, type_hash: str = "") -> Announced:
        """Announce here what the other side has.

        Args:
            token: Token of the other side.
            type_hash: Hash in place of the token's own.
        """
        node_id = self._take_node_id(token)
        domain, session = self.domain, self.transport.session_id
        mirrored: NodeToken | EndpointToken
        if isinstance(token, EndpointToken):
            # Without further fields: who names no memory backend is sent the plain key (CPU_BACKEND).
            mirrored = token._replace(
                domain=domain,
                session=session,
                node_id=node_id,
                endpoint_id=str(next(self._ids)),
                type_hash=type_hash or token.type_hash,
                more="",
            )
        else:
            mirrored = token._replace(domain=domain, session=session, node_id=node_id, more="")
        text = format_token(mirrored)
        gid = gid_of(text)
        self.own.add(gid)
        return Announced(mirrored, gid, self.transport.announce(text))

    def withdraw(self, announced: Announced, token: NodeToken | EndpointToken) -> None:
        """End the announcement, which was made for the other side's `token`."""
        announced.handle.close()
        self.lane.post(functools.partial(self.own.discard, announced.gid))  # behind echoes that wait there
        self._drop_node_id(token)

    def _take_node_id(self, token: NodeToken | EndpointToken) -> str:
        # By whatever token comes first: an endpoint's may come before its node's.
        node = (token.session, token.node_id)
        number, users = self._node_ids.get(node) or (str(next(self._ids)), 0)
        self._node_ids[node] = number, users + 1
        return number

    def _drop_node_id(self, token: NodeToken | EndpointToken) -> None:
        node = (token.session, token.node_id)
        number, users = self._node_ids[node]
        if users > 1:
            self._node_ids[node] = number, users - 1
        else:
            del self._node_ids[node]

    def key(self, token: EndpointToken) -> str:
        """Return the key of an endpoint here."""
        return format_key(DataKey(self.domain, token.name, token.type_name, token.type_hash))


def gids_of(gid: bytes, token: EndpointToken) -> tuple[bytes, ...]:
    """Return the gids by which samples of an endpoint come, the first ones first.

    On DDS a sample may come before it is known which node its writer belongs to, and so before there is a token; then
    its gid is the writer's GUID, of which the token has the two halves as session and id (`robolink.dds.graph`).
    """
    if len(token.session) == 2 * _PREFIX_BYTES and len(token.endpoint_id) == 2 * _ENTITY_BYTES:
        with contextlib.suppress(ValueError):  # an id that is not in hex
            return bytes.fromhex(token.session + token.endpoint_id), gid
    return (gid,)


_PREFIX_BYTES, _ENTITY_BYTES = 12, 4


class Later(NamedTuple):
    """Ways to do something later on the mirror's thread, which alone changes what is declared."""

    call: Callable[[Callable[[], object]], object]
    """Run a function on it soon; from any thread."""
    now: Callable[[], float]
    """Return the time in seconds."""
    call_after: Callable[[float, Callable[[], object]], object]
    """Run a function on it after so many seconds; only from that thread."""
