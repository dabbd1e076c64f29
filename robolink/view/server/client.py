"""Client of the view's server: one WebSocket, what it has subscribed to, and the dispatch of what it asks."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Coroutine
from typing import TYPE_CHECKING, Any, TypeVar

from robolink.exceptions import RobolinkError
from robolink.system.terminal import shown
from robolink.view.channels import Channel
from robolink.view.protocol import answers, requests
from robolink.view.protocol.answers import ERROR, FOXGLOVE_WEBSOCKET, ROBOLINK, WARNING
from robolink.view.protocol.requests import ProtocolError
from robolink.view.server.outbox import Outbox, Wire
from robolink.view.server.publishing import Calling, Publishing

if TYPE_CHECKING:
    from robolink.view.server.hub import Hub

MOST_SUBSCRIPTIONS = 5000
"""Upper bound of the subscriptions of one client."""

MOST_UNREAD = 32 * 2**20
"""Bytes of answers that a client may leave unread, before its connection is cut."""

MOST_TASKS = 100
"""Requests of one client that wait for nodes."""

MOST_MISTAKES = 100
"""Mistakes that a client is told of; the rest is only counted."""


class Client:
    """One connection to the server.

    Args:
        hub: Server that it is a client of.
        wire: Transport of its connection.
        subprotocol: Subprotocol that it speaks.
        trusted: True if it may change something.
        name: Its address, for logs.
    """

    def __init__(self, hub: Hub, wire: Wire, subprotocol: str, *, trusted: bool, name: str) -> None:
        self.hub, self.trusted, self.name, self.subprotocol = hub, trusted, name, subprotocol
        self.is_page = subprotocol == ROBOLINK
        self.is_legacy = subprotocol == FOXGLOVE_WEBSOCKET
        self.outbox = Outbox(wire, batching=self.is_page)
        self.mistakes = 0
        self._publishing = Publishing(hub.system, hub.stopping) if hub.system and hub.stopping else None
        self._calling = Calling(self, hub.system) if hub.system is not None else None
        self._tasks: set[asyncio.Task[None]] = set()
        self._wire = wire
        self._channels: dict[int, Channel] = {}

    # To the client

    def say(self, text: str) -> None:
        """Send an operation in JSON."""
        self._write(text.encode(), answers.TEXT)

    def send(self, body: bytes) -> None:
        """Send a binary operation."""
        self._write(body, answers.BINARY)

    def _write(self, body: bytes, first: int) -> None:
        if self._wire.is_closing():
            return
        if self._wire.get_write_buffer_size() > MOST_UNREAD:
            self._wire.abort()
            return
        self._wire.write(answers.head(len(body), first) + body)

    def complain(self, message: str, level: int = ERROR) -> None:
        """Report to the client, as a status, what was wrong; not again and again."""
        self.mistakes += 1
        if self.mistakes <= MOST_MISTAKES:
            self.say(answers.status(level, shown(message, 1000)))
        elif self.mistakes == MOST_MISTAKES + 1:
            self.say(answers.status(level, "more mistakes follow, and are no longer told"))

    def greet(self) -> None:
        """Send what a new client is told: the server's abilities, channels and services."""
        self.say(answers.text("serverInfo", **self.hub.information(self)))
        self.advertise(list(self.hub.source.channels.values()))
        self.hub.greet(self)

    def advertise(self, channels: list[Channel]) -> None:
        """Announce new channels; hidden ones only robolink's own page."""
        seen = [each.advertisement(all_of_it=self.is_page) for each in channels if self.is_page or not each.hidden]
        if seen:
            self.say(answers.text("advertise", channels=seen))

    def unadvertise(self, channels: list[Channel]) -> None:
        """Withdraw channels that have gone; subscriptions to them end."""
        gone = {each.id for each in channels}
        for number in [number for number, each in self._channels.items() if each.id in gone]:
            self._unsubscribe(number)
        seen = [each.id for each in channels if self.is_page or not each.hidden]
        if seen:
            self.say(answers.text("unadvertise", channelIds=seen))

    # From the client

    def receive(self, raw: str | bytes) -> None:
        """Do what a message of the client asks; what is wrong with it is told in a status."""
        try:
            request = requests.decode(raw)
            _HANDLERS[type(request)](self, request)
        except RobolinkError as error:
            self.complain(str(error))

    def _subscribe(self, request: requests.Subscribe) -> None:
        taken = set(self._channels.values())
        for each in request.subscriptions:
            channel = self.hub.source.channels.get(each.channel_id)
            if channel is None:
                self.complain(f"subscribe: there is no channel {each.channel_id}", WARNING)
            elif each.id in self._channels:
                self.complain(f"subscribe: subscription {each.id} is there already, of {self._channels[each.id].topic}")
            elif channel in taken:
                self.complain(f"subscribe: {channel.topic} is subscribed already, and once is enough for one client")
            elif len(self._channels) >= MOST_SUBSCRIPTIONS:
                self.complain(f"subscribe: more than {MOST_SUBSCRIPTIONS} subscriptions of one client")
                return
            else:
                taken.add(channel)
                self._begin(each, channel)

    def _begin(self, request: requests.SubscriptionRequest, channel: Channel) -> None:
        self._channels[request.id] = channel
        retained = self.hub.source.retained(channel)
        take = self.outbox.want(request.id, request.rate, latched=channel.latched, retained=retained)
        channel.takers = [*channel.takers, take]
        self.hub.source.listen(channel)

    def _on_unsubscribe(self, request: requests.Unsubscribe) -> None:
        for number in request.subscription_ids:
            if number in self._channels:
                self._unsubscribe(number)
            else:
                self.complain(f"unsubscribe: there is no subscription {number}", WARNING)

    def _unsubscribe(self, number: int) -> None:
        channel = self._channels.pop(number)
        take = self.outbox.forget(number)
        channel.takers = [each for each in channel.takers if each is not take]
        self.hub.leave_if_unused(channel)

    def _acknowledge(self, request: requests.Acknowledge) -> None:
        self.outbox.acknowledge()
        self.outbox.flush(self.hub.now())

    # What changes something

    def _publisher(self) -> Publishing:
        """Return the publisher's side of this client. Raises ProtocolError if it may not publish."""
        self._check_trust("publishing")
        return _there(self._publishing, "publishing")

    def _check_trust(self, what: str) -> None:
        if not self.trusted:
            raise ProtocolError(
                f"{what} is refused, since this connection is read-only: open the address with the token"
            )

    def _advertise(self, request: requests.Advertise) -> None:
        publishing = self._publisher()
        for each in request.channels:
            self._try(lambda each=each: publishing.advertise(each))  # type: ignore[misc]

    def _unadvertise(self, request: requests.Unadvertise) -> None:
        publishing = self._publisher()
        for each in request.channel_ids:
            self._try(lambda each=each: publishing.unadvertise(each))  # type: ignore[misc]

    def _try(self, action: Callable[[], object]) -> None:
        """Do one of several things; what is wrong with it does not keep the others back."""
        try:
            action()
        except RobolinkError as error:
            self.complain(str(error))

    def _publish(self, request: requests.MessageData) -> None:
        self._publisher().publish(request.channel_id, request.payload, self.hub.now())

    def _call(self, request: requests.ServiceCall) -> None:
        try:
            self._check_trust("calling services")
            _there(self._calling, "calling services").begin(request)
        except RobolinkError as error:
            self.say(answers.service_call_failure(request.service_id, request.call_id, str(error)))

    def _get_parameters(self, request: requests.GetParameters) -> None:
        parameters = _there(self.hub.parameters, "parameters")
        self._later(parameters.get(self, request.parameter_names, request.id))

    def _set_parameters(self, request: requests.SetParameters) -> None:
        self._check_trust("setting parameters")
        parameters = _there(self.hub.parameters, "parameters")
        self._later(parameters.set(self, request.parameters, request.id))

    def _follow_parameters(self, request: requests.SubscribeParameterUpdates) -> None:
        _there(self.hub.parameters, "parameters").follow(self, request.parameter_names)

    def _unfollow_parameters(self, request: requests.UnsubscribeParameterUpdates) -> None:
        _there(self.hub.parameters, "parameters").unfollow(self, request.parameter_names)

    def _follow_graph(self, request: requests.SubscribeConnectionGraph) -> None:
        _there(self.hub.connections, "the graph").follow(self)

    def _unfollow_graph(self, request: requests.UnsubscribeConnectionGraph) -> None:
        _there(self.hub.connections, "the graph").part(self)

    def _follow_statistics(self, request: requests.SubscribeStatistics) -> None:
        self.hub.statistics.follow(self)

    def _unfollow_statistics(self, request: requests.UnsubscribeStatistics) -> None:
        self.hub.statistics.part(self)

    def _record(self, request: requests.Record) -> None:
        self._check_trust("recording")
        self._later(_there(self.hub.recorder, "recording").obey(request))

    def _stop(self, request: requests.Stop) -> None:
        self._check_trust("release of STOP" if not request.held else "STOP")
        _there(self.hub.stopping, "STOP").set(request.held)

    def _learn(self, request: requests.Learn) -> None:
        if request.command != "show":
            self._check_trust(f"learn {request.command}")
        if self.hub.learning is None:
            raise ProtocolError("learn: there are no exercises here; `robolink learn view` shows a folder of them")
        self._later(self.hub.learning.obey(request, self.say))

    def _control(self, request: requests.PlaybackControl) -> None:
        self.hub.control(self, request)

    def _later(self, coroutine: Coroutine[Any, Any, None]) -> None:
        """Answer when nodes have answered."""
        if len(self._tasks) >= MOST_TASKS:
            coroutine.close()
            raise ProtocolError(f"more than {MOST_TASKS} requests are under way")
        task = asyncio.get_running_loop().create_task(self._answered(coroutine))
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    async def _answered(self, coroutine: Coroutine[Any, Any, None]) -> None:
        try:
            await coroutine
        except RobolinkError as error:
            self.complain(str(error))
        except Exception as error:  # noqa: BLE001 - no request may end the server
            self.hub.fail(error)

    def _fetch_asset(self, request: requests.FetchAsset) -> None:
        self.send(answers.asset_refusal(request.request_id, "this server hands out no files"))

    def tick(self, now: float) -> None:
        """Send what waits, and stop what a stalled client drives; `now` in seconds."""
        self.outbox.flush(now)
        if self._publishing is not None:
            self._publishing.tick(now)

    def close(self) -> None:
        """End all that this client has begun; what it drives stops first. Safe to call twice."""
        if self._publishing is not None:
            self._publishing.close()
        if self._calling is not None:
            self._calling.close()
        for each in list(self._tasks):
            each.cancel()
        for number in list(self._channels):
            self._unsubscribe(number)


PartT = TypeVar("PartT")


def _there(part: PartT | None, what: str) -> PartT:
    """Return a part of the server; raises ProtocolError where a bag is shown, which has none."""
    if part is None:
        raise ProtocolError(f"{what}: there is no running system here, but a bag")
    return part


_HANDLERS: dict[type[Any], Callable[[Client, Any], None]] = {
    requests.Subscribe: Client._subscribe,
    requests.Unsubscribe: Client._on_unsubscribe,
    requests.Acknowledge: Client._acknowledge,
    requests.FetchAsset: Client._fetch_asset,
    requests.Advertise: Client._advertise,
    requests.Unadvertise: Client._unadvertise,
    requests.MessageData: Client._publish,
    requests.ServiceCall: Client._call,
    requests.GetParameters: Client._get_parameters,
    requests.SetParameters: Client._set_parameters,
    requests.SubscribeParameterUpdates: Client._follow_parameters,
    requests.UnsubscribeParameterUpdates: Client._unfollow_parameters,
    requests.SubscribeConnectionGraph: Client._follow_graph,
    requests.UnsubscribeConnectionGraph: Client._unfollow_graph,
    requests.PlaybackControl: Client._control,
    requests.Record: Client._record,
    requests.Stop: Client._stop,
    requests.Learn: Client._learn,
    requests.SubscribeStatistics: Client._follow_statistics,
    requests.UnsubscribeStatistics: Client._unfollow_statistics,
}
