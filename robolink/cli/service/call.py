"""Calls of a service for `robolink service call`, once or at a rate."""

from __future__ import annotations

import contextlib
from typing import TYPE_CHECKING, Any, NamedTuple

from robolink.cli.shared import messages
from robolink.cli.shared.graph import domains_with, hint
from robolink.cli.shared.messages import GivenRequest, message_of
from robolink.cli.shared.output import say, tell
from robolink.cli.shared.session import node_of, opened
from robolink.exceptions import NotFoundError, RobolinkError, nearest
from robolink.interfaces import find, is_named
from robolink.system import clocks
from robolink.system.terminal import shown
from robolink.wire import EndpointKind

if TYPE_CHECKING:
    from robolink.client import Client
    from robolink.context import Context
    from robolink.executors import Executor

PATIENCE = 1.0
"""Wait for an answer until the reason is printed, in seconds."""

_SLICE = 0.25
"""Longest single wait, in seconds: on Windows Ctrl-C does not end a wait."""


class CallError(RobolinkError, RuntimeError):
    """A call cannot be made, or was not answered."""


class Manner(NamedTuple):
    """Options of `service call`: how often, and how long an answer may take."""

    rate: float | None = None
    """Rate of the calls, in Hz; None for one call."""
    timeout: float = 5.0
    """Timeout of an answer, in seconds, with the wait for the service."""
    json: bool = False
    node_name: str = ""

    def problem(self) -> str:
        """Return what is wrong with these options; empty if nothing is."""
        if self.rate is not None and not 1e-9 <= self.rate < float("inf"):
            return f"--rate: expected a number of Hz above 0, got {self.rate:g}"
        if not 0 < self.timeout <= 1e9:
            return f"--timeout: expected a number of seconds above 0, got {self.timeout:g}"
        return ""


def run(service: str, type_: str, values: str, manner: Manner) -> None:
    """Call a service once, or at a rate until Ctrl-C.

    Raises CallError if there is no answer in time, ServiceError if the server goes away or its answer cannot be
    read, NotFoundError for an unknown type, DocumentError or EncodeError for a wrong request.
    """
    with opened() as context:
        from robolink.executors import SingleThreadedExecutor

        node = node_of(context, manner.node_name)
        given = GivenRequest(node.resolve_service_name(service), type_, values)
        deadline = clocks.monotonic() + manner.timeout
        srv_type = _wait_for_type(context, given, manner, deadline)
        request = message_of(srv_type.Request, values)
        client = node.create_client(srv_type, given.name)
        executor = SingleThreadedExecutor(context=context)
        executor.add_node(node)
        while True:
            began = clocks.monotonic()
            _call(client, executor, request, manner, deadline)
            if manner.rate is None:
                return
            _sleep(executor, began + 1.0 / manner.rate)
            deadline = clocks.monotonic() + manner.timeout


def _wait_for_type(context: Context, given: GivenRequest, manner: Manner, deadline: float) -> type[Any]:
    """Wait until the service is there, with the type that is named, if one is; return its class."""
    from robolink.cli.shared.messages import service_type

    if not _served(context, given):
        _check_early(given)
        if not manner.json:
            say("waiting for service to become available...")
        _wait(context, given, manner, deadline)
    return service_type(context, given.name, given.type_)


def _check_early(given: GivenRequest) -> None:
    """Check the request before the wait for the service, if its type is installed."""
    if given.type_:
        with contextlib.suppress(NotFoundError):  # the server may know it
            message_of(find(given.type_, "srv").Request, given.values)


def _served(context: Context, given: GivenRequest) -> bool:
    servers = context.graph.endpoints(EndpointKind.SERVICE, name=given.name)
    return any(not given.type_ or is_named(each.type_name, given.type_) for each in servers)


def _wait(context: Context, given: GivenRequest, manner: Manner, deadline: float) -> None:
    patience = clocks.monotonic() + PATIENCE
    while not context.graph.wait_for(lambda: _served(context, given) or not context.ok(), _SLICE):
        now = clocks.monotonic()
        if now >= deadline:
            raise CallError(f"gave up after {manner.timeout:g} s: {_why_absent(context, given)}")
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


def _call(client: Client, executor: Executor, request: Any, manner: Manner, deadline: float) -> None:
    if not manner.json:
        say(f"requester: making request: {request!r}\n")
    future = client.try_call_async(request)
    _spin(executor, future, min(PATIENCE, deadline - clocks.monotonic()))
    if not future.done() and clocks.monotonic() < deadline:
        tell(f"waiting: {_server_of(executor, client)} has not answered yet")
        _spin(executor, future, deadline - clocks.monotonic())
    if not future.done():
        client.remove_pending_request(future)
        raise CallError(f"no answer within {manner.timeout:g} s from {_server_of(executor, client)}")
    response = future.result()
    if manner.json:
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
