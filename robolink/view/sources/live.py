"""Source of a running system: its topics and services as clients see them, and calls of its services."""

from __future__ import annotations

import asyncio
import contextlib
import itertools
import os
import queue
import struct
from collections import OrderedDict, deque
from collections.abc import Callable, Iterable
from typing import Any

from robolink.client import Client
from robolink.exceptions import RobolinkError, ServiceError, SessionReplacedError
from robolink.graph.endpoint import timed_arrival
from robolink.graph.graph import EVERY
from robolink.message import Service
from robolink.networks.request import requested
from robolink.node import Node
from robolink.system import clocks
from robolink.time_source import CLOCK_TOPIC
from robolink.topic_or_service_is_hidden import topic_or_service_is_hidden
from robolink.transport.base import Handle
from robolink.view.channels import Audience, Channel, Retained, ServiceEntry
from robolink.view.protocol.answers import WARNING
from robolink.view.sources.listening import Listening, latches
from robolink.view.sources.types import PATIENCE, Types, published
from robolink.wire import EndpointKind, EndpointToken

MOST_CLIENTS = 32
"""Clients of services that are kept for the next call."""

CLOCK_TYPE = "rosgraph_msgs/msg/Clock"

CALM = 0.05
"""Delay after a change of the graph, in seconds, in which more of them are gathered."""

AT_ONCE = 0.02
"""Time in seconds that may be spent on subscriptions between two sweeps."""

_TOPIC, _SERVICE = EndpointKind.PUBLISHER, EndpointKind.SERVICE


class Caller:
    """Caller of any services, for one node.

    Args:
        node: Node whose clients call; nobody needs to spin it.
    """

    def __init__(self, node: Node) -> None:
        self._node = node
        self._clients: OrderedDict[tuple[str, type[Any]], Client] = OrderedDict()
        self._busy: dict[Client, int] = {}

    async def call(self, name: str, cls: type[Service], request: bytes, within: float) -> bytes:
        """Call a service, and return its serialized response.

        Args:
            name: Full name of the service.
            cls: Its class.
            request: Serialized request.
            within: Longest wait, in seconds.

        Raises:
            ServiceError: (a RuntimeError) if nobody answers in time, or nobody serves it.
        """
        loop = asyncio.get_running_loop()
        answer: asyncio.Future[bytes] = loop.create_future()

        def arrived(item: Any) -> None:
            """Note an answer, or the end of all, on a thread of the network."""
            with contextlib.suppress(RuntimeError):  # the loop has ended
                loop.call_soon_threadsafe(self._note, name, answer, item)

        client = self._client(name, cls)
        self._busy[client] = self._busy.get(client, 0) + 1
        handle = client._send_(request, arrived)
        try:
            return await asyncio.wait_for(answer, within)
        except asyncio.TimeoutError:
            raise ServiceError(f"service {name}: no answer within {within:g} s") from None
        finally:
            handle.close()
            self._busy[client] -= 1
            self._tidy()

    def _note(self, name: str, answer: asyncio.Future[bytes], item: Any) -> None:
        if answer.done():
            return
        if item is None:
            answer.set_exception(ServiceError(f"service {name}: nobody serves it, or the server went away"))
            return
        try:
            answer.set_result(self._node.context.transport.read(item).payload)
        except SessionReplacedError as error:
            answer.set_exception(ServiceError(f"service {name}: {error}"))
        except RobolinkError as error:
            answer.set_exception(ServiceError(f"service {name}: the answer cannot be read: {error}"))

    def _client(self, name: str, cls: type[Any]) -> Client:
        key = (name, cls)
        found = self._clients.get(key)
        if found is None:
            found = self._clients[key] = self._node.create_client(cls, name)
        self._clients.move_to_end(key)
        return found

    def _tidy(self) -> None:
        """End the clients that were not used for long."""
        for key, client in list(self._clients.items()):
            if len(self._clients) <= MOST_CLIENTS:
                return
            if not self._busy.get(client):
                del self._clients[key]
                self._busy.pop(client, None)
                self._node.destroy_client(client)


class LiveSource:
    """Topics and services of the system that a node sees.

    Args:
        node: Node that listens; it needs nobody who spins it.
    """

    def __init__(self, node: Node) -> None:
        self.node, self.context = node, node.context
        self.channels: dict[int, Channel] = {}
        self.services: dict[int, ServiceEntry] = {}
        self.unreadable = 0
        """Number of messages that could not be read, since their sender had overwritten them."""
        self.types = Types(self.context)
        self._numbers = itertools.count(1)
        self._arrived: queue.SimpleQueue[Any] = queue.SimpleQueue()
        self._arrival = timed_arrival(self._arrived.put, clocks.now)
        self._listening: dict[int, Listening] = {}
        self._postponed: dict[int, Channel] = {}
        self._spent = 0.0
        """Time spent on subscriptions since the last sweep, in seconds."""
        self._by_name: dict[tuple[str, EndpointKind], Channel | ServiceEntry] = {}
        self._ends: dict[tuple[str, EndpointKind], dict[bytes, EndpointToken]] = {}
        self._news: deque[tuple[bytes, EndpointToken, bool]] = deque()
        self._soon = False
        self._following: list[Handle] = []
        self._announced: set[str] = set()
        self.caller = Caller(node)
        self._clock_channel: Channel | None = None
        self._clock = self._shown_clock = 0
        self.followers: list[Callable[[], object]] = []
        """Functions that are called when the graph has changed."""

    # The graph

    def begin(self, audience: Audience) -> None:
        """Begin to look for channels and services, in a running loop."""
        self._audience, self._loop = audience, asyncio.get_running_loop()
        for kind in (_TOPIC, _SERVICE, EndpointKind.SUBSCRIPTION):
            self._following.append(self.context.graph.follow(EVERY, kind, self._on_news))
        self._look()

    def _on_news(self, gid: bytes, token: EndpointToken, alive: bool) -> None:
        """Note a change of the graph, on any thread."""
        self._news.append((gid, token, alive))
        if not self._soon:
            self._soon = True
            with contextlib.suppress(RuntimeError):  # the loop has ended
                self._loop.call_soon_threadsafe(self._loop.call_later, CALM, self._look)

    def _look(self) -> None:
        self._soon = False
        changed: dict[tuple[str, EndpointKind], None] = {}
        while self._news:
            gid, token, alive = self._news.popleft()
            place = (token.name, token.kind)
            ends = self._ends.setdefault(place, {})
            if alive:
                ends[gid] = token
            else:
                ends.pop(gid, None)
                self._forget_sender(place, gid)
            changed[place] = None
        self._settle(place for place in changed if place[1] is not EndpointKind.SUBSCRIPTION)
        self._tell_followers()

    def _settle_again(self, place: tuple[str, EndpointKind]) -> None:
        """Advertise what is at this place, now that its type was looked up."""
        self._settle([place])
        self._tell_followers()

    def _tell_followers(self) -> None:
        self._follow_clock()
        for each in self.followers:
            each()

    def _forget_sender(self, place: tuple[str, EndpointKind], gid: bytes) -> None:
        channel = self._by_name.get(place)
        listening = self._listening.get(channel.id) if isinstance(channel, Channel) else None
        if listening is not None:
            listening.forget(gid)

    def _settle(self, places: Iterable[tuple[str, EndpointKind]]) -> None:
        """Advertise what is new at these places, and take back what has gone."""
        came: list[Channel | ServiceEntry] = []
        gone: list[Channel | ServiceEntry] = []
        for place in places:
            ends = self._ends.get(place, {})
            known = self._by_name.get(place)
            if known is not None and not any(_fits(known, each) for each in ends.values()):
                gone.append(self._remove(place))
                known = None
            if not ends:
                self._ends.pop(place, None)
                self._take_back(f"type {place[0]}")
            elif known is None:
                made = self._make(place, next(iter(ends.values())))
                came += [made] if made is not None else []
            elif isinstance(known, Channel):
                self._follow(known, ends)
            self._tell_of_types(place, ends)
        self._publish_changes(came, gone)

    def _publish_changes(self, came: list[Channel | ServiceEntry], gone: list[Channel | ServiceEntry]) -> None:
        tell = self._audience
        if gone:
            tell.channels_went([each for each in gone if isinstance(each, Channel)])
            tell.services_went([each for each in gone if isinstance(each, ServiceEntry)])
        if came:
            tell.channels_came([each for each in came if isinstance(each, Channel)])
            tell.services_came([each for each in came if isinstance(each, ServiceEntry)])

    def _remove(self, place: tuple[str, EndpointKind]) -> Channel | ServiceEntry:
        known = self._by_name.pop(place)
        if isinstance(known, Channel):
            self.leave(known)
            del self.channels[known.id]
        else:
            del self.services[known.id]
        return known

    def _make(self, place: tuple[str, EndpointKind], end: EndpointToken) -> Channel | ServiceEntry | None:
        """Return a new channel or service, None while its type is being looked up, or is not to be had."""
        found = self.types.get(end)
        if found is None:
            self.types.look_up(end, self._loop, lambda: self._settle_again(place))
            return None
        if isinstance(found, str):
            self._tell(f"type {end.name}", found)
            self._loop.call_later(PATIENCE, self._settle_again, place)
            return None
        self._take_back(f"type {end.name}")
        number = next(self._numbers)
        made: Channel | ServiceEntry
        if place[1] is _SERVICE:
            hidden = topic_or_service_is_hidden(end.name)
            made = self.services[number] = ServiceEntry(number, end.name, end.type_name, found[0], found[1], hidden)
        else:
            made = self.channels[number] = Channel(number, end.name, end.type_name, found[0].schema, end.type_hash)
            made.latched = latches(self._ends[place].values())
        self._by_name[place] = made
        return made

    def _follow(self, channel: Channel, ends: dict[bytes, EndpointToken]) -> None:
        """Listen to new publishers of a channel, too."""
        channel.latched = latches(ends.values())
        listening = self._listening.get(channel.id)
        if listening is not None:
            listening.follow(ends)

    def _tell_of_types(self, place: tuple[str, EndpointKind], ends: dict[bytes, EndpointToken]) -> None:
        known = self._by_name.get(place)
        if known is None:
            return
        others = {each.type_name: each.full_node_name for each in ends.values() if not _fits(known, each)}
        id_ = f"types {place[0]}"
        if others:
            what = ", ".join(f"{name} by {node}" for name, node in others.items())
            self._tell(id_, f"{place[0]} is shown as {known.type_name}; it is also {what}, which is left out")
        else:
            self._take_back(id_)

    def _tell(self, id_: str, message: str) -> None:
        self._announced.add(id_)
        self._audience.tell(WARNING, message, id_)

    def _take_back(self, id_: str) -> None:
        if id_ in self._announced:
            self._announced.discard(id_)
            self._audience.take_back(id_)

    # What the parts of the server ask

    def service_names(self) -> set[str]:
        """Return the names of all services."""
        return {each.name for each in self.services.values()}

    def serves(self, name: str) -> bool:
        """Return whether the graph has a service, shown or not yet."""
        return self.context.graph.count(_SERVICE, name) > 0

    def service_class(self, number: int) -> type[Any] | None:
        """Return the class of a service, None if there is no such service."""
        entry = self.services.get(number)
        ends = self._ends.get((entry.name, _SERVICE), {}) if entry is not None else {}
        return next(filter(None, (self.types.class_of(each) for each in ends.values() if _fits(entry, each))), None)

    def channel_of(self, topic: str) -> Channel | None:
        """Return the channel of a topic, None if there is none."""
        found = self._by_name.get((topic, _TOPIC))
        return found if isinstance(found, Channel) else None

    def ends(self, channel: Channel) -> tuple[int, int]:
        """Return how many publishers and subscriptions a channel has; this view's own is not counted."""
        listeners = len(self._ends.get((channel.topic, EndpointKind.SUBSCRIPTION), {}))
        own = channel.id in self._listening
        return len(self._ends.get((channel.topic, _TOPIC), {})), max(0, listeners - own)

    def time(self) -> int:
        """Return the time of the system, in ns: that of /clock where there is one."""
        return self._clock or clocks.now()

    def _follow_clock(self) -> None:
        channel = self.channel_of(CLOCK_TOPIC)
        if channel is not None and channel.type_name != CLOCK_TYPE:
            channel = None
        before, self._clock_channel = self._clock_channel, channel
        if channel is None:
            self._clock = 0
        elif channel is not before:
            channel.takers = [*channel.takers, self._on_clock]
            self.listen(channel)
        if (channel is None) != (before is None):
            self._audience.capabilities_changed()

    def _on_clock(self, at: int, payload: bytes, sender: bytes) -> None:
        if len(payload) >= 12:
            seconds, nanoseconds = struct.unpack_from("<iI" if payload[1] & 1 else ">iI", payload, 4)
            self._clock = seconds * 10**9 + nanoseconds

    # Messages

    def listen(self, channel: Channel) -> None:
        """Begin to receive a channel, with what its publishers keep for late subscribers.

        Of many at once some wait for the next sweeps: 200 take 0.13 s, in which no robot could be stopped.
        """
        if channel.id in self._listening or channel.id in self._postponed:
            return
        if self._spent >= AT_ONCE:
            self._postponed[channel.id] = channel
        else:
            self._listen_now(channel)

    def _listen_now(self, channel: Channel) -> None:
        begin = clocks.monotonic()
        made = self._listening[channel.id] = Listening(self.node._owner_, channel, self._arrival)
        made.follow(self._ends.get((channel.topic, _TOPIC), {}))
        self._spent += clocks.monotonic() - begin

    def leave(self, channel: Channel) -> None:
        """Receive it no longer."""
        self._postponed.pop(channel.id, None)
        listening = self._listening.pop(channel.id, None)
        if listening is not None:
            listening.close()

    def retained(self, channel: Channel) -> list[Retained]:
        """Return the messages that a late subscriber of a latched channel gets."""
        listening = self._listening.get(channel.id)
        return [] if listening is None else listening.retained()

    def now(self) -> int:
        """Return the system's time, in ns since the epoch."""
        return clocks.now()

    def sweep(self) -> None:
        """Deliver all that has arrived."""
        self._spent = 0.0
        while self._postponed and self._spent < AT_ONCE:
            self._listen_now(self._postponed.pop(next(iter(self._postponed))))
        get, read, size = self._arrived.get_nowait, self.context.transport.read, self.context.transport.size
        for _ in range(self._arrived.qsize()):
            arrived = get()
            listening: Listening = arrived.target
            try:
                if listening.reads:
                    listening.deliver(arrived.at, *read(arrived.content))
                else:
                    listening.channel.note(arrived.at, size(arrived.content))
            except RobolinkError:  # overwritten in shared memory, as that of a slow reader may be
                self.unreadable += 1
        if self._clock > 0 and self._clock != self._shown_clock:
            self._shown_clock = self._clock
            self._audience.time_is(self._clock)

    # What is offered

    def capabilities(self) -> list[str]:
        """Return the server's capabilities, in Foxglove's words."""
        offered = ["clientPublish", "services", "parameters", "parametersSubscribe", "connectionGraph"]
        return [*offered, "time"] if self._clock_channel is not None else offered

    def information(self) -> dict[str, Any]:
        """Return fields of `serverInfo`."""
        network = requested(None, os.environ).value
        own = {"bag": None, "domain": self.context.get_domain_id(), "network": network[:120], "types": published()}
        return {"robolink": own}

    def close(self) -> None:
        """Let go of everything."""
        for each in self._following:
            each.close()
        for listening in self._listening.values():
            listening.close()
        self._listening.clear()
        self.types.close()


def _fits(known: Channel | ServiceEntry | None, end: EndpointToken) -> bool:
    return known.fits(end) if isinstance(known, Channel) else known is not None and known.type_name == end.type_name
