"""Hub of the view's server: the clients, what they are all told, and the tick on which messages go out."""

from __future__ import annotations

import asyncio
import contextlib
from collections.abc import Iterable
from importlib.metadata import PackageNotFoundError, version
from typing import Any

from robolink.logging import get_logger
from robolink.system import clocks
from robolink.view.channels import LARGEST, Channel, ServiceEntry, Source
from robolink.view.protocol import answers
from robolink.view.protocol.answers import ENCODINGS, WARNING
from robolink.view.protocol.requests import PlaybackControl, ProtocolError
from robolink.view.server.client import Client
from robolink.view.server.connections import Connections
from robolink.view.server.learning import Exercises, Learning
from robolink.view.server.parameters import Parameters
from robolink.view.server.recording import Recorder
from robolink.view.server.statistics import PERIOD as STATISTICS
from robolink.view.server.statistics import Statistics
from robolink.view.server.stopping import Stopping
from robolink.view.sources.bag import BagSource
from robolink.view.sources.live import LiveSource

PERIOD = 1 / 60
"""Interval of the tick, in seconds: a thread woken by each message fights with the loop for Python's lock."""

TRUSTED = ("clientPublish", "services")
"""Capabilities that a read-only client is not offered. It keeps "parameters", one word for reading and setting them."""
IDLE = 0.25
"""Interval without clients, in seconds."""

MOST_CLIENTS = 50

DISTRO = "jazzy"
"""ROS distribution by whose rules Foxglove's clients read the types; they know no others than ROS 2's own."""


class Hub:
    """All clients of one source. Everything is called on the server's loop.

    Args:
        source: Where the messages come from.
        host: Address that the server listens at, for clients to know.
        session: Id of this run of the server, by which clients see that it was started again.
        exercises: Exercises for the page; None for none.
        read_only: True if nobody may change anything.
    """

    def __init__(
        self,
        source: Source,
        host: str,
        session: str,
        exercises: Exercises | None = None,
        *,
        read_only: bool = False,
    ) -> None:
        self.source, self._host, self._session = source, host, session
        self.bag = source if isinstance(source, BagSource) else None
        self.system = source if isinstance(source, LiveSource) else None
        self.parameters = Parameters(self.system) if self.system is not None else None
        self.connections = Connections(self.system) if self.system is not None else None
        self.statistics = Statistics(source, clocks.monotonic if self.bag is None else self._bag_seconds)
        self.stopping = None if self.system is None else Stopping(self.system, self._tell_pages, keeps=not read_only)
        self.recorder = Recorder(self.system, self._tell_pages) if self.system is not None else None
        self.learning = Learning(exercises, self._tell_pages) if exercises is not None else None
        self.clients: set[Client] = set()
        self.sent = self.dropped = 0
        """Messages of clients that have gone."""
        self._statuses: dict[str, tuple[int, str]] = {}
        self._somebody = asyncio.Event()
        self._statistics_due = 0.0
        self._logger = get_logger("robolink.view")
        self.failures = 0
        """Number of errors that nobody expected; the first is logged."""

    def now(self) -> float:
        """Return the time of a steady clock, in seconds."""
        return clocks.monotonic()

    def _bag_seconds(self) -> float:
        return self.source.now() / 1e9

    def join(self, client: Client) -> None:
        """Greet a client, and serve it from now on."""
        client.greet()
        self.clients.add(client)
        self._somebody.set()

    def part(self, client: Client) -> None:
        """End what a client has begun, whose connection has ended."""
        self.clients.discard(client)
        self.statistics.part(client)
        for each in (self.parameters, self.connections):
            if each is not None:
                each.part(client)
        client.close()
        self.sent += client.outbox.sent
        self.dropped += client.outbox.dropped
        if not self.clients:
            self._somebody.clear()

    def information(self, client: Client) -> dict[str, Any]:
        """Return the fields of a client's `serverInfo`."""
        shown: dict[str, Any] = {
            "name": "robolink",
            "capabilities": [each for each in self.source.capabilities() if client.trusted or each not in TRUSTED],
            "supportedEncodings": list(ENCODINGS),
            "metadata": {"ROS_DISTRO": DISTRO},
            "sessionId": self._session,
        }
        given = self.source.information()
        own = {"version": _version(), "readOnly": not client.trusted, "host": self._host, **given["robolink"]}
        own["exercises"] = self.learning is not None
        return shown | given | {"robolink": own}

    def greet(self, client: Client) -> None:
        """Send a new client the services, and what is wrong."""
        self._tell_services(client, self.source.services.values())
        for id_, (level, message) in self._statuses.items():
            client.say(answers.status(level, message, id_))
        if self.bag is not None:
            client.send(self.bag.playback_state(did_seek=False))
        if client.is_page and self.stopping is not None:
            client.say(self.stopping.state())
        if client.is_page and self.recorder is not None:
            client.say(self.recorder.state())
        if client.is_page and self.learning is not None:
            client.say(self.learning.state())

    def leave_if_unused(self, channel: Channel) -> None:
        """Receive a channel no longer, if nobody wants it."""
        if not channel.takers and not self.statistics.followed:
            self.source.leave(channel)

    async def run(self) -> None:
        """Deliver what arrives, on each tick; a few times a second while there are no clients."""
        while True:
            if not self.clients:
                with contextlib.suppress(asyncio.TimeoutError):
                    held = self.stopping is not None and self.stopping.held
                    await asyncio.wait_for(self._somebody.wait(), PERIOD if held else IDLE)
            begin = self.now()
            try:
                self.tick(begin)
            except Exception as error:  # noqa: BLE001 - no message may end the server
                self.fail(error)
            await asyncio.sleep(max(0.001, begin + PERIOD - self.now()))

    def tick(self, now: float) -> None:
        """Deliver what has arrived, and send it to all clients; `now` in seconds."""
        try:
            self.source.sweep()
        except Exception as error:  # noqa: BLE001 - a message that cannot be read; robots must be stopped all the same
            self.fail(error)
        ticking: list[Stopping | Client] = [*self.clients]
        for each in ticking if self.stopping is None else [self.stopping, *ticking]:
            try:
                each.tick(now)
            except Exception as error:  # noqa: BLE001 - the other clients go on
                self.fail(error)
        if now >= self._statistics_due:
            self._statistics_due = now + STATISTICS
            self._tell_of_giants()
            if self.recorder is not None:
                self.recorder.tick()
            self.statistics.tick(len(self.clients), self.dropped + sum(each.outbox.dropped for each in self.clients))

    def _tell_of_giants(self) -> None:
        for each in self.source.channels.values():
            if each.too_large:
                text = f"{each.topic}: messages that are larger than {LARGEST // 2**20} MiB are not shown"
                self.tell(WARNING, text, f"large {each.topic}")

    def fail(self, error: Exception) -> None:
        """Note an error that nobody expected."""
        self.failures += 1
        if self.failures == 1:
            self._logger.error(f"a part of the view failed (the next ones are only counted): {error!r}")

    def _tell_pages(self, text: str) -> None:
        for each in self.clients:
            if each.is_page:
                each.say(text)

    def close(self) -> None:
        """Stop what clients drive, record and check."""
        for each in list(self.clients):
            each.close()
        if self.stopping is not None:
            self.stopping.close()
        if self.recorder is not None:
            self.recorder.close()
        if self.learning is not None:
            self.learning.close()

    def begin(self) -> None:
        """Begin to listen to STOP, and to check exercises, in a running loop."""
        if self.stopping is not None:
            self.stopping.begin()
        if self.learning is not None:
            self.learning.begin()

    # What the source tells

    def capabilities_changed(self) -> None:
        """Announce to Foxglove's clients anew what can be done here; they keep their session by its id."""
        for each in self.clients:
            each.say(answers.text("serverInfo", **self.information(each)))

    def channels_came(self, channels: Iterable[Channel]) -> None:
        """Advertise channels."""
        new = list(channels)
        for each in self.clients:
            each.advertise(new)
        self.statistics.measure(new)

    def channels_went(self, channels: Iterable[Channel]) -> None:
        """Take channels back."""
        gone = list(channels)
        for each in self.clients:
            each.unadvertise(gone)
        self.statistics.forget(gone)
        for channel in gone:
            self.take_back(f"large {channel.topic}")

    def services_came(self, services: Iterable[ServiceEntry]) -> None:
        """Advertise services."""
        new = list(services)
        for each in self.clients:
            self._tell_services(each, new)

    def _tell_services(self, client: Client, services: Iterable[ServiceEntry]) -> None:
        seen = [
            each.advertisement(all_of_it=client.is_page, legacy=client.is_legacy)
            for each in services
            if _sees(client, each)
        ]
        if seen:
            client.say(answers.text("advertiseServices", services=seen))

    def services_went(self, services: Iterable[ServiceEntry]) -> None:
        """Take services back."""
        gone = list(services)
        for client in self.clients:
            seen = [each.id for each in gone if _sees(client, each)]
            if seen:
                client.say(answers.text("unadvertiseServices", serviceIds=seen))

    def tell(self, level: int, message: str, id_: str) -> None:
        """Show a status to all clients, also to those that come later, until it is taken back."""
        if self._statuses.get(id_) == (level, message):
            return
        self._statuses[id_] = (level, message)
        for each in self.clients:
            each.say(answers.status(level, message, id_))

    def take_back(self, id_: str) -> None:
        """Take a status back."""
        if self._statuses.pop(id_, None) is not None:
            for each in self.clients:
                each.say(answers.text("removeStatus", statusIds=[id_]))

    def time_is(self, now: int) -> None:
        """Send clients the time of the system, in ns."""
        body = answers.time(now)
        for each in self.clients:
            each.send(body)

    def playback_changed(self, *, did_seek: bool) -> None:
        """Send clients the state of the playback of a bag."""
        if self.bag is not None:
            body = self.bag.playback_state(did_seek=did_seek)
            for each in self.clients:
                each.send(body)

    def control(self, client: Client, request: PlaybackControl) -> None:
        """Control the playback of a bag; the client that asked is answered by the id of its request."""
        if self.bag is None:
            raise ProtocolError("playback: there is no bag here, but a running system")
        if request.seek is not None:
            for each in self.clients:
                each.outbox.clear()
        did_seek = self.bag.control(request)
        if did_seek:
            self.statistics.jump()
        for each in self.clients:
            id_ = request.request_id if each is client else ""
            each.send(self.bag.playback_state(did_seek=did_seek, request_id=id_))


def _version() -> str:
    """Return robolink's version; "" for a clone that runs without being installed."""
    try:
        return version("robolink")
    except PackageNotFoundError:
        return ""


def _sees(client: Client, service: ServiceEntry) -> bool:
    """True if a client is told of a service: the page of all, others of those that they may call."""
    return client.is_page or (client.trusted and not service.hidden)
