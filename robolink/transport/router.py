"""Router: the installed Zenoh in router mode, for those who have none, ROS 2 nodes included."""

from __future__ import annotations

import contextlib
import json
import os
from collections.abc import Iterator, Sequence

import zenoh

from robolink.exceptions import TransportError
from robolink.networks import limits
from robolink.networks.asked import domain_id
from robolink.networks.router import router_settings
from robolink.transport import securing
from robolink.transport.network import reason
from robolink.transport.port_sharing import PortClaim, is_taken
from robolink.transport.reach import Link, links_of, port_of


class Router:
    """A running router; made by `running`."""

    def __init__(self, session: zenoh.Session) -> None:
        self._session = session
        self.session_id = str(session.info.zid())

    def links(self) -> list[Link]:
        """Return the connections to others."""
        return links_of(self._session)


@contextlib.contextmanager
def running(listen: Sequence[str], connect: Sequence[str]) -> Iterator[Router]:
    """Run a router while a `with` lasts.

    Args:
        listen: Zenoh's endpoints on which it listens.
        connect: Those to which it connects, and goes on trying to.

    Raises:
        TransportError: if a port is taken, or if it cannot listen there; SecurityError if the environment asks for
            security, and keys are missing.
    """
    config = zenoh.Config.from_json5(json.dumps(router_settings(listen, connect)))
    if limited := limits.wanted(os.environ):
        limits.apply(config, limited, domain_id(os.environ))
    securing.secure_router(config, os.environ)
    with contextlib.ExitStack() as stack:
        for each in listen:
            claim = PortClaim(port_of(each))
            stack.callback(claim.release)
            if not claim.granted or is_taken(each):
                raise TransportError(
                    f"{each} is taken, perhaps by another router ('robolink doctor' says by whom): "
                    "stop that one, use it, or choose another port with --listen HOST:PORT"
                )
        try:
            session = zenoh.open(config)
        except zenoh.ZError as error:
            raise TransportError(f"cannot listen at {' and '.join(listen)}: {reason(error)}") from None
        stack.callback(_close, session)
        yield Router(session)


def _close(session: zenoh.Session) -> None:
    with contextlib.suppress(zenoh.ZError, RuntimeError):
        session.close()  # type: ignore[no-untyped-call]
