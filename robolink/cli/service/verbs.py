"""The verbs of services: the nodes of a service, calls, and events of introspection."""

from __future__ import annotations

import contextlib
from typing import TYPE_CHECKING, Any, NamedTuple

from robolink.cli.shared import messages
from robolink.cli.shared.graph import absolute, announced, domains_with, hint
from robolink.cli.shared.messages import GivenRequest, message_of, service_type
from robolink.cli.shared.output import say, say_json, tell
from robolink.cli.shared.session import looking, node_of, opened
from robolink.endpoint_info import dotted
from robolink.exceptions import NotFoundError, RobolinkError, nearest
from robolink.executors import SingleThreadedExecutor
from robolink.interfaces import find, is_named
from robolink.interfaces.service_msgs.msg import ServiceEventInfo
from robolink.node_parts.graph_queries import service_endpoint
from robolink.qos import qos_profile_services_default
from robolink.service_introspection import SUFFIX
from robolink.system import clocks
from robolink.system.terminal import shown
from robolink.task import Future
from robolink.wire import EndpointKind, EndpointToken, gid_of

if TYPE_CHECKING:
    from robolink.client import Client
    from robolink.context import Context
    from robolink.executors import Executor
    from robolink.graph.graph import Token


TITLES = {EndpointKind.CLIENT: "Clients count", EndpointKind.SERVICE: "Services count"}
ROLES = {EndpointKind.CLIENT: "CLIENT", EndpointKind.SERVICE: "SERVER"}


class End(NamedTuple):
    """A server or client, and its gid."""

    token: EndpointToken
    gid: bytes


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
    say(f"Type: {types[0] if len(types) == 1 else types}")
    for kind, title in TITLES.items():
        of_kind = [each for each in ends if each.token.kind is kind]
        say(f"{title}: {len(of_kind)}{more}")
        for each in of_kind if verbose else ():
            say(f"{service_endpoint(each.gid, each.token)}\n")


def _ends(tokens: dict[str, Token], name: str, where: str) -> list[End]:
    found = [
        End(each, gid_of(text))
        for text, each in tokens.items()
        if isinstance(each, EndpointToken) and each.kind in TITLES
    ]
    ends = [each for each in found if each.token.name == name]
    if not ends:
        raise NotFoundError("service", shown(name), {each.token.name for each in found}, where)
    return sorted(ends, key=lambda each: (each.token.full_node_name, each.gid))


def _as_json(ends: list[End]) -> dict[str, list[dict[str, str]]]:
    return {
        f"{role.lower()}s": [
            {"node": token.full_node_name, "type": token.type_name, "hash": token.type_hash, "gid": dotted(gid)}
            for token, gid in ends
            if token.kind is kind
        ]
        for kind, role in ROLES.items()
    }


PATIENCE = 1.0
"""Wait for an answer until the reason is printed, in seconds."""

_SLICE = 0.25
"""Longest single wait, in seconds: on Windows Ctrl-C does not end a wait."""


class CallError(RobolinkError, RuntimeError):
    """A call cannot be made, or was not answered."""


class Mode(NamedTuple):
    """Options of `service call`: how often, and how long an answer may take."""

    rate: float | None = None
    """Rate of the calls, in Hz; None for one call."""
    timeout: float = 5.0
    """Timeout of an answer, in seconds, with the wait for the service."""
    json: bool = False
    node_name: str = ""

    def problem(self) -> str:
        """Return the error of these options; empty if there is none."""
        if self.rate is not None and not 1e-9 <= self.rate < float("inf"):
            return f"--rate: expected a number of Hz above 0, got {self.rate:g}"
        if not 0 < self.timeout <= 1e9:
            return f"--timeout: expected a number of seconds above 0, got {self.timeout:g}"
        return ""


def call(service: str, type_: str, values: str, mode: Mode) -> None:
    """Call a service once, or at a rate until Ctrl-C.

    Raises CallError if there is no answer in time, ServiceError if the server goes away or its answer cannot be
    read, NotFoundError for an unknown type, DocumentError or EncodeError for a wrong request.
    """
    with opened() as context:
        from robolink.executors import SingleThreadedExecutor

        node = node_of(context, mode.node_name)
        given = GivenRequest(node.resolve_service_name(service), type_, values)
        deadline = clocks.monotonic() + mode.timeout
        srv_type = _wait_for_type(context, given, mode, deadline)
        request = message_of(srv_type.Request, values)
        client = node.create_client(srv_type, given.name)
        executor = SingleThreadedExecutor(context=context)
        executor.add_node(node)
        while True:
            began = clocks.monotonic()
            _call(client, executor, request, mode, deadline)
            if mode.rate is None:
                return
            _sleep(executor, began + 1.0 / mode.rate)
            deadline = clocks.monotonic() + mode.timeout


def _wait_for_type(context: Context, given: GivenRequest, mode: Mode, deadline: float) -> type[Any]:
    """Wait until the service is there, with the type that is named, if one is; return its class."""
    from robolink.cli.shared.messages import service_type

    if not _served(context, given):
        _check_early(given)
        if not mode.json:
            say("waiting for service to become available...")
        _wait(context, given, mode, deadline)
    return service_type(context, given.name, given.type_)


def _check_early(given: GivenRequest) -> None:
    """Check the request before the wait for the service, if its type is installed."""
    if given.type_:
        with contextlib.suppress(NotFoundError):  # the server may know it
            message_of(find(given.type_, "srv").Request, given.values)


def _served(context: Context, given: GivenRequest) -> bool:
    servers = context.graph.endpoints(EndpointKind.SERVICE, name=given.name)
    return any(not given.type_ or is_named(each.type_name, given.type_) for each in servers)


def _wait(context: Context, given: GivenRequest, mode: Mode, deadline: float) -> None:
    patience = clocks.monotonic() + PATIENCE
    while not context.graph.wait_for(lambda: _served(context, given) or not context.ok(), _SLICE):
        now = clocks.monotonic()
        if now >= deadline:
            raise CallError(f"gave up after {mode.timeout:g} s: {_why_absent(context, given)}")
        if now >= patience:
            patience = float("inf")
            tell(f"waiting: {_why_absent(context, given)}")
    if not context.ok():
        raise KeyboardInterrupt


def _why_absent(context: Context, given: GivenRequest) -> str:
    """Return the reason why there is no such service."""
    served = context.graph.endpoints(EndpointKind.SERVICE)
    types = sorted({each.type_name for each in served if each.name == given.name})
    if types:
        return f"{given.name} is served as {' and '.join(types)}, not as {shown(given.type_)}"
    elsewhere = hint(domains_with(context, given.name, EndpointKind.SERVICE))
    near = "" if elsewhere else nearest(given.name, sorted({each.name for each in served}))
    return f"nobody serves {given.name} on domain {context.get_domain_id()}{elsewhere}{near}"


def _call(client: Client, executor: Executor, request: Any, mode: Mode, deadline: float) -> None:
    if not mode.json:
        say(f"requester: making request: {request!r}\n")
    future = client.try_call_async(request)
    _spin(executor, future, min(PATIENCE, deadline - clocks.monotonic()))
    if not future.done() and clocks.monotonic() < deadline:
        tell(f"waiting: {_server_of(executor, client)} has not answered yet")
        _spin(executor, future, deadline - clocks.monotonic())
    if not future.done():
        client.remove_pending_request(future)
        raise CallError(f"no answer within {mode.timeout:g} s from {_server_of(executor, client)}")
    response = future.result()
    if mode.json:
        say(messages.as_json({"request": messages.plain(request), "response": messages.plain(response)}))
    else:
        say(f"response:\n{response!r}\n")


def _spin(executor: Executor, future: Any, seconds: float) -> None:
    executor.spin_until_future_complete(future, timeout_sec=max(0.0, seconds))
    if not executor.context.ok():
        raise KeyboardInterrupt


def _sleep(executor: Executor, until: float) -> None:
    from robolink.task import Future

    _spin(executor, Future[None](), until - clocks.monotonic())


def _server_of(executor: Executor, client: Client) -> str:
    """Return the name of the node that serves, as far as it is known."""
    found = executor.context.graph.endpoints(EndpointKind.SERVICE, name=client.service_name)
    if not found:
        return f"{client.service_name}, which nobody serves any more"
    return f"{client.service_name} of {found[0].full_node_name}"


NAMES = {number: name for name, (_, number) in ServiceEventInfo.__ros_constants__.items()}
"""Names of the kinds of events, by number."""


class Format(NamedTuple):
    """Format in which events are shown."""

    style: messages.Style = messages.Style()
    csv: bool = False
    json: bool = False

    def text(self, event: Any) -> str:
        """Return an event as text, like ros2: with a name in place of its number but for CSV."""
        if self.csv:
            return messages.as_csv(event, self.style)
        event.info.event_type = NAMES.get(event.info.event_type, event.info.event_type)
        return messages.as_json(event) if self.json else f"{messages.as_yaml(event, self.style)}\n---"


def echo(service: str, type_: str, form: Format, *, once: bool = False) -> None:
    """Show what a service and its clients say to each other, until Ctrl-C; one event if `once`.

    Raises NotFoundError for an unknown service or type.
    """
    done: Future[None] = Future()

    def on_event(event: Any) -> None:
        if done.done():
            return
        try:
            say(form.text(event))
        except (RobolinkError, OSError) as error:  # a closed pipe
            done.set_exception(error)
            return
        if once:
            done.set_result(None)

    with opened() as context:
        node = node_of(context)
        name = node.resolve_service_name(service)
        events = service_type(context, name, type_).Event
        subscription = node.create_subscription(events, name + SUFFIX, on_event, qos_profile_services_default)
        if subscription.get_publisher_count() < 1:
            tell(
                f"No publishers on topic '{name}{SUFFIX}'; is service introspection on the client or server enabled?"
                " (node.create_service(...).configure_introspection(...))"
            )
        with SingleThreadedExecutor(context=context) as executor:
            executor.add_node(node)
            executor.spin_until_future_complete(done)
        if done.done():
            done.result()
