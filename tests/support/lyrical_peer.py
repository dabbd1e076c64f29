"""Fake camera node of ROS 2 Lyrical, on bare transport calls: tokens and samples as rmw_zenoh 0.10.5 sends them.

Its types hold a `uint8[]`. So its token names the backends of its buffers, and where it sends hangs on what each
subscription announces: to `KEY/_buf_cpu`, once, for all that take main memory; to `KEY/_buf/GID` for each other one;
and nowhere while there is none. One counter numbers it all.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable
from typing import Any

from robolink.message import encode, type_hash, type_name
from robolink.qos import QoSProfile
from robolink.transport import Outlet, Transport
from tests.support.ros2_peer import gid_of, packed_attachment

PLAIN, QOS = QoSProfile(depth=10), "::,10:,:,:,,"
CPU = "backends:cpu:"


class LyricalPublisher:
    """A publisher; `on_subscription` is called when another subscription has come that it sends to."""

    def __init__(
        self,
        session: Transport,
        topic: str,
        msg_type: type[Any],
        *,
        domain: int = 0,
        on_subscription: Callable[[LyricalPublisher], object] = lambda publisher: None,
    ) -> None:
        package, _, name = type_name(msg_type).split("/")
        what = f"{package}::msg::dds_::{name}_/{type_hash(msg_type)}"
        self.session, self.key = session, f"{domain}{topic}/{what}"
        node = f"@ros2_lv/{domain}/{session.session_id}/0"
        self.token = f"{node}/1/MP/%/%/camera_driver/{topic.replace('/', '%')}/{what}/{QOS}/{CPU}"
        self.gid, self.numbers = gid_of(self.token), itertools.count(1)
        self.subscriptions: set[str] = set()
        self.used: set[str] = set()
        """The keys to which something was sent."""
        self._what, self._on_subscription = f"/{topic.replace('/', '%')}/{what}/", on_subscription
        self._outlets: dict[str, Outlet] = {}
        self._announced = [session.announce(f"{node}/0/NN/%/%/camera_driver"), session.announce(self.token)]
        session.watch(f"@ros2_lv/{domain}/**", self._on_token)

    def put(self, *messages: Any) -> None:
        """Publish."""
        for payload in map(encode, messages):
            for key in sorted({self._way(token) for token in self.subscriptions.copy()}):
                self.used.add(key)
                attachment = packed_attachment(next(self.numbers), 5, self.gid)
                self._outlet(key).put(payload, attachment)

    def close(self) -> None:
        """Leave the graph."""
        for each in self._announced:
            each.close()

    def _on_token(self, token: str, alive: bool) -> None:
        if "/MS/" not in token or self._what not in token:
            return
        if alive:
            self.subscriptions.add(token)
            self._outlet(self._way(token))
            self._on_subscription(self)
        else:
            self.subscriptions.discard(token)

    def _way(self, token: str) -> str:
        if token.split("/")[13:] == [CPU]:
            return f"{self.key}/_buf_cpu"
        return f"{self.key}/_buf/{gid_of(token).hex()}"

    def _outlet(self, key: str) -> Outlet:
        if key not in self._outlets:
            self._outlets[key] = self.session.advertise(key, PLAIN)
        return self._outlets[key]
