"""Bridge between Zenoh and DDS: a session on each with a mirror between them, and a look whether one is there already.

Two bridges between the same two networks would double every node, message and call. So each announces itself on both,
by a token on Zenoh and a mark in its participant's user data on DDS, and whoever finds another on both refuses. One
that is found on one of them only is between other networks.
"""

from __future__ import annotations

import contextlib
import socket
import time
from collections.abc import Iterable, Mapping
from typing import Protocol, TypeVar

from robolink.dds.mirror import Count, Mirror
from robolink.dds.network import open_session, refuse_security
from robolink.exceptions import RobolinkError, WireError
from robolink.system import clocks
from robolink.transport import open_zenoh
from robolink.wire import (
    RUNNING,
    STARTING,
    BridgeToken,
    Mark,
    bridge_pattern,
    format_bridge,
    mark_data,
    mark_in,
    parse_bridge,
)

MET_WITHIN = 1.2
"""Time in seconds within which the participant of a bridge that Zenoh shows is met on DDS, if it is there."""

LOOK_EVERY = 0.02
"""Interval of the looks for it, in seconds."""


class _Closes(Protocol):
    def close(self) -> object: ...


_ClosesT = TypeVar("_ClosesT", bound=_Closes)


class TwoBridgesError(RobolinkError, RuntimeError):
    """Another bridge joins the same two networks."""


class Bridge:
    """Bridge between Zenoh and DDS on one domain, until it is closed."""

    def __init__(
        self, domain: int, network: str | None, environ: Mapping[str, str], dds_environ: Mapping[str, str]
    ) -> None:
        """Join both networks, and mirror.

        Args:
            domain: ROS domain id.
            network: Zenoh network, as for `robolink.transport.connect`; None is that of `environ`.
            environ: Environment, for Zenoh.
            dds_environ: Environment for DDS: as far as its variables say.

        Raises:
            TransportError: if one of the networks cannot be joined.
            SecurityError: where security is on, unless ROBOLINK_DDS_UNSECURED is 1.
            TwoBridgesError: if another bridge joins the same two networks.
        """
        refuse_security(dds_environ)
        self._domain, self._host = domain, socket.gethostname()
        self._open: list[_Closes] = []
        self._state = STARTING
        self._seen: set[str] = set()
        try:
            self.zenoh = zenoh = self._closing(open_zenoh(domain, network, environ))
            mark = mark_data(Mark(zenoh.session_id, self._host))
            self.dds = self._closing(open_session(domain, dds_environ, mark=mark))
            state = zenoh.announce(self._token(STARTING))
            self._closing(zenoh.watch(bridge_pattern(domain), self._on_token))
            self._seen.update(zenoh.tokens(bridge_pattern(domain)))
            self._await_no_other()
            self._state = RUNNING
            self._closing(zenoh.announce(self._token(RUNNING)))
            state.close()
            self._mirror = self._closing(Mirror(zenoh, self.dds, domain))
            self._mirror.start()
        except BaseException:
            self.close()
            raise

    def _closing(self, opened: _ClosesT) -> _ClosesT:
        self._open.append(opened)
        return opened

    def _token(self, state: str) -> str:
        return format_bridge(BridgeToken(self._domain, self.zenoh.session_id, "dds", self._host, state))

    # Other bridges

    def _on_token(self, text: str, alive: bool) -> None:
        (self._seen.add if alive else self._seen.discard)(text)

    def _await_no_other(self) -> None:
        """Return once no other bridge can be on both sides that was there before; raises TwoBridgesError if one is."""
        deadline = clocks.monotonic() + MET_WITHIN
        while others_in(self._seen, self.zenoh.session_id) and clocks.monotonic() < deadline:
            self.check()
            time.sleep(LOOK_EVERY)
        self.check()

    def check(self) -> None:
        """Raise TwoBridgesError if there is another bridge that stays: also one that was met later, on one side."""
        others = others_in(self._seen, self.zenoh.session_id)
        if not others:
            return
        marks = {found.mark for each in self.dds.peers() if (found := mark_in(each.user_data)) is not None}
        both = [each for each in others if each.mark in marks]
        other = one_that_stays(self.zenoh.session_id, self._state, both)
        if other is not None:
            raise TwoBridgesError(
                f"another bridge, on {other.host}, joins the same two networks, and all would come twice: this one ends"
            )

    def count(self) -> Count:
        """Return the counts of what the bridge has met: on Zenoh, and on DDS."""
        return self._mirror.count()

    def close(self) -> None:
        """Leave both networks. Safe to call twice."""
        while self._open:
            self._open.pop().close()


def others_in(tokens: Iterable[str], own_session: str) -> list[BridgeToken]:
    """Return the bridges to DDS among tokens, but for one's own."""
    found = []
    for text in [*tokens]:
        with contextlib.suppress(WireError):
            bridge = parse_bridge(text)
            if bridge.network == "dds" and bridge.session != own_session:
                found.append(bridge)
    return found


def one_that_stays(session: str, state: str, others: Iterable[BridgeToken]) -> BridgeToken | None:
    """Return a bridge for which another one must end; None if that stays.

    One that runs stays, and whoever starts ends. Of two that start, or have met only while they ran, the one with the
    smaller id stays: both decide the same.

    Args:
        session: Session of the one that decides.
        state: Its state, STARTING or RUNNING.
        others: The others between the same networks.
    """
    for other in others:
        if other.state == state:
            if other.session < session:
                return other
        elif other.state == RUNNING:
            return other
    return None
