"""Parameters of all nodes for clients: a cache, so that a node that does not answer holds nobody up.

Nodes are asked when the first client wants parameters, and when they come; after that `/parameter_events` says what
has changed.
"""

from __future__ import annotations

import asyncio
from collections import Counter
from collections.abc import Awaitable, Callable, Iterable
from typing import Any

from robolink.exceptions import RobolinkError, nearest
from robolink.interfaces.rcl_interfaces.msg import ParameterEvent, ParameterValue
from robolink.interfaces.rcl_interfaces.srv import GetParameters, ListParameters, SetParameters
from robolink.message import decode, encode
from robolink.view.channels import Channel
from robolink.view.protocol import answers
from robolink.view.protocol.answers import ERROR, WARNING
from robolink.view.protocol.parameters import ParameterName, from_json, name_of, to_json
from robolink.view.protocol.requests import ParameterRequest
from robolink.view.server.outbox import Listener
from robolink.view.sources.live import LiveSource

EVENTS = "/parameter_events"
ANSWER_WITHIN = 2.0
"""Longest wait for one node's answer, in seconds."""

FIRST_WITHIN = 0.6
"""Longest wait of the first client for the nodes' first answers, in seconds."""

AT_ONCE = 8
"""Nodes that are asked at once."""

AGAIN_AFTER = 10.0
"""Time after which a node that did not answer is asked again, in seconds, when somebody wants its parameters."""

MOST_ROUNDS = 3
"""Most times that a node is asked whose parameters change meanwhile."""

_MARK = "/get_parameters"
_Values = dict[str, ParameterValue]


class Parameters:
    """Cache of all nodes' parameters, with the clients that want to hear of changes.

    Args:
        system: System whose nodes have them.
    """

    def __init__(self, system: LiveSource) -> None:
        self._system = system
        self._cache: dict[str, _Values] = {}
        self._fetching: dict[str, asyncio.Task[None]] = {}
        self._silent: dict[str, float] = {}
        self._changes: Counter[str] = Counter()
        """Number of events of each node, by which a change while it is asked is noticed."""
        self._followers: dict[Listener, set[str] | None] = {}
        self._reported: dict[ParameterName, dict[str, Any]] = {}
        """Values that followers know: an event that repeats a client's own request is sent to nobody."""
        self._setting: Counter[tuple[Listener, str]] = Counter()
        """Requests under way, by client and parameter; each is answered once, whenever the event comes."""
        self._slots = asyncio.Semaphore(AT_ONCE)
        self._active = False
        self._channel: Channel | None = None
        system.followers.append(self._look)

    # What the nodes say

    def _begin(self) -> None:
        self._active = True
        self._look()

    def _look(self) -> None:
        """Follow the nodes that come and go, once somebody wants parameters."""
        if not self._active:
            return
        self._attach()
        now = asyncio.get_running_loop().time()
        nodes = {name.removesuffix(_MARK) for name in self._system.service_names() if name.endswith(_MARK)}
        for node in [*self._cache, *self._fetching, *self._silent]:
            if node not in nodes:
                self._forget(node)
        for node in nodes - self._cache.keys() - self._fetching.keys():
            if now - self._silent.get(node, -AGAIN_AFTER) >= AGAIN_AFTER:
                self._fetching[node] = asyncio.get_running_loop().create_task(self._fetch(node))

    def _attach(self) -> None:
        channel = self._system.channel_of(EVENTS)
        if channel is not None and channel is not self._channel:
            self._channel = channel
            channel.takers = [*channel.takers, self._on_event]
            self._system.listen(channel)

    def _forget(self, node: str) -> None:
        self._cache.pop(node, None)
        self._silent.pop(node, None)
        self._changes.pop(node, None)
        for name in [each for each in self._reported if each.node == node]:
            del self._reported[name]
        task = self._fetching.pop(node, None)
        if task is not None:
            task.cancel()

    async def _fetch(self, node: str) -> None:
        try:
            async with self._slots:
                values = await self._all_values(node)
        except RobolinkError:
            self._silent[node] = asyncio.get_running_loop().time()
        else:
            self._silent.pop(node, None)
            self._cache[node] = values
            self._tell(ParameterName(node, name) for name in values)
        finally:
            if self._fetching.get(node) is asyncio.current_task():  # it may have come back, and be asked anew
                del self._fetching[node]

    async def _all_values(self, node: str) -> _Values:
        """Ask for all parameters of a node."""

        async def read() -> _Values:
            listed = await self._ask(node, "list_parameters", ListParameters, ListParameters.Request())
            return await self._values(node, list(listed.result.names))

        return await self._fresh(node, read)

    async def _fresh(self, node: str, read: Callable[[], Awaitable[_Values]]) -> _Values:
        """Read from a node; anew if something has changed meanwhile, but not without end.

        An event may be handled before an answer that is older.
        """
        for _ in range(MOST_ROUNDS - 1):
            before = self._changes[node]
            values = await read()
            if self._changes[node] == before:
                return values
        return await read()

    async def _values(self, node: str, names: list[str]) -> _Values:
        if not names:
            return {}
        answer = await self._ask(node, "get_parameters", GetParameters, GetParameters.Request(names=names))
        return dict(zip(names, answer.values, strict=False))

    async def _ask(self, node: str, service: str, cls: type[Any], request: Any) -> Any:
        raw = await self._system.caller.call(f"{node}/{service}", cls, encode(request), ANSWER_WITHIN)
        return decode(cls.Response, raw)

    def _on_event(self, at: int, payload: bytes, sender: bytes) -> None:
        """Note what has changed, from a message of /parameter_events."""
        try:
            event: Any = decode(ParameterEvent, payload)
        except RobolinkError:
            return
        if event.node in self._cache or event.node in self._fetching:
            self._changes[event.node] += 1
        values = self._cache.get(event.node)
        if values is None:
            return
        changed = [*event.new_parameters, *event.changed_parameters]
        values.update({each.name: each.value for each in changed})
        for each in event.deleted_parameters:
            values.pop(each.name, None)
        self._tell(ParameterName(event.node, each.name) for each in [*changed, *event.deleted_parameters])

    def _tell(self, names: Iterable[ParameterName]) -> None:
        """Send the values that are new to the clients that follow them."""
        values = {name: to_json(name, self._cached(name)) for name in names}
        changed = {str(name): value for name, value in values.items() if self._reported.get(name) != value}
        self._reported.update(values)
        for client in self._followers:
            shown = self._followed(client, changed)
            if shown:
                client.say(answers.text("parameterValues", parameters=shown))

    def _followed(self, client: Listener, values: dict[str, dict[str, Any]]) -> list[dict[str, Any]]:
        """Return those of the values that a client follows and is not setting now."""
        followed = self._followers.get(client, set())
        return [
            value
            for name, value in values.items()
            if (followed is None or name in followed) and not self._setting[client, name]
        ]

    def _cached(self, name: ParameterName) -> ParameterValue | None:
        return self._cache.get(name.node, {}).get(name.name)

    # What clients ask

    def follow(self, client: Listener, names: list[str]) -> None:
        """Send a client what changes: the named parameters, all if none is named."""
        self._begin()
        before = self._followers.get(client, set())
        self._followers[client] = None if not names or before is None else before | set(names)

    def unfollow(self, client: Listener, names: list[str]) -> None:
        """Send a client no more of these changes, of none if none is named."""
        before = self._followers.get(client)
        left = before - set(names) if names and before is not None else set()
        if left:
            self._followers[client] = left
        else:
            self._followers.pop(client, None)

    def part(self, client: Listener) -> None:
        """Forget a client."""
        self._followers.pop(client, None)

    async def get(self, client: Listener, names: list[str], id_: str | None) -> None:
        """Answer `getParameters`: all that is known, or the named ones as their nodes have them now."""
        self._begin()
        if names:
            shown = await self._named(client, names)
        else:
            if self._fetching:
                await asyncio.wait(self._fetching.values(), timeout=FIRST_WITHIN)
            shown = [to_json(ParameterName(node, name), self._cache[node][name]) for node, name in self._all()]
        client.say(answers.text("parameterValues", parameters=shown, id=id_))

    def _all(self) -> list[tuple[str, str]]:
        return [(node, name) for node in sorted(self._cache) for name in sorted(self._cache[node])]

    async def _named(self, client: Listener, texts: list[str]) -> list[dict[str, Any]]:
        names = [name_of(each) for each in texts]
        nodes: dict[str, list[str]] = {}
        for each in names:
            nodes.setdefault(each.node, []).append(each.name)
        there = self._there(client, nodes)
        await asyncio.gather(*(self._refresh(client, node, nodes[node]) for node in there))
        return [shown for each in names if "value" in (shown := to_json(each, self._cached(each)))]

    def _there(self, client: Listener, nodes: Iterable[str]) -> list[str]:
        """Return those of these nodes that there are; the client is told of the first that is not."""
        there: list[str] = []
        missing: list[str] = []
        for each in nodes:
            (there if self._system.serves(f"{each}{_MARK}") else missing).append(each)
        if missing:
            known = [each.removesuffix(_MARK) for each in self._system.service_names() if each.endswith(_MARK)]
            more = f"; nor are {len(missing) - 1} others" if len(missing) > 1 else ""
            client.complain(
                f"parameters of {missing[0]}: there is no such node{nearest(missing[0], known)}{more}", WARNING
            )
        return there

    async def _refresh(self, client: Listener, node: str, names: list[str]) -> None:
        try:
            values = await self._fresh(node, lambda: self._values(node, names))
        except RobolinkError as error:
            client.complain(f"parameters of {node}: {error}", WARNING)
            return
        self._cache.setdefault(node, {}).update(values)

    async def set(self, client: Listener, requested: list[ParameterRequest], id_: str | None) -> None:
        """Set parameters, and tell the client what a node refuses and why; with an id it gets the values that are."""
        self._begin()
        by_node: dict[str, list[ParameterRequest]] = {}
        for each in requested:
            by_node.setdefault(name_of(each.name).node, []).append(each)
        there = self._there(client, by_node)
        under_way = [(client, each.name) for each in requested]
        self._setting.update(under_way)
        try:
            await asyncio.gather(*(self._set(client, node, by_node[node]) for node in there))
        finally:
            self._setting -= Counter(under_way)
        shown = {each.name: to_json(name_of(each.name), self._cached(name_of(each.name))) for each in requested}
        if id_ is not None:
            client.say(answers.text("parameterValues", parameters=list(shown.values()), id=id_))
        elif followed := self._followed(client, shown):
            client.say(answers.text("parameterValues", parameters=followed))

    async def _set(self, client: Listener, node: str, requested: list[ParameterRequest]) -> None:
        names = [name_of(each.name).name for each in requested]
        await self._refresh(client, node, names)
        known = self._cache.get(node, {})
        try:
            given = [
                from_json(each, known[name].type if name in known else 0)
                for each, name in zip(requested, names, strict=True)
            ]
            answer = await self._ask(node, "set_parameters", SetParameters, SetParameters.Request(parameters=given))
        except RobolinkError as error:
            client.complain(f"parameters of {node} are not set: {error}")
            return
        for name, result in zip(names, answer.results, strict=False):
            if not result.successful:
                client.complain(f"{node}.{name} is not set: {result.reason or 'the node gave no reason'}", ERROR)
        await self._refresh(client, node, names)
        self._tell(ParameterName(node, name) for name in names)
