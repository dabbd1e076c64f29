"""What `robolink service call` does."""

from __future__ import annotations

import contextlib
import time
from typing import TYPE_CHECKING, Any, NamedTuple

from robolink.cli import show
from robolink.cli.asked import Asked, message_of
from robolink.cli.elsewhere import domains_with, hint
from robolink.cli.output import say, tell
from robolink.cli.session import node_of, opened
from robolink.exceptions import NotFoundError, RobolinkError, nearest, shown
from robolink.interfaces import find, is_named
from robolink.wire import EndpointKind

if TYPE_CHECKING:
    from robolink.client import Client
    from robolink.context import Context
    from robolink.executors import Executor

PATIENCE = 1.0
"""Seconds without an answer after which the reason is given."""

_SLICE = 0.25
"""Seconds of one wait: on Windows Ctrl-C does not end a wait that is longer."""


class CallError(RobolinkError, RuntimeError):
    """A call that cannot be made, or that nobody answered."""


class Manner(NamedTuple):
    """How a service is called."""

    rate: float | None = None
    """Calls a second; None for one call."""
    timeout: float = 5.0
    """Seconds until the answer has to be there, the wait for the service included."""
    json: bool = False
    node_name: str = ""

    def problem(self) -> str:
        """Say what cannot be; nothing if it can."""
        if self.rate is not None and not 1e-9 <= self.rate < float("inf"):
            return f"--rate: expected a number of Hz above 0, got {self.rate:g}"
        if not 0 < self.timeout <= 1e9:
            return f"--timeout: expected a number of seconds above 0, got {self.timeout:g}"
        return ""


def run(service: str, type_: str, values: str, manner: Manner) -> None:
    """Call a service once, or at a rate until Ctrl-C.

    Raises CallError when nobody answers in time, ServiceError when the server goes away or answers what is no
    answer, NotFoundError for an unknown type, DocumentError or EncodeError for a wrong request.
    """
    with opened() as context:
        from robolink.executors import SingleThreadedExecutor

        node = node_of(context, manner.node_name)
        asked = Asked(node.resolve_service_name(service), type_, values)
        deadline = time.monotonic() + manner.timeout
        srv_type = _wait_for_type(context, asked, manner, deadline)
        request = message_of(srv_type.Request, values)
        client = node.create_client(srv_type, asked.name)
        executor = SingleThreadedExecutor(context=context)
        executor.add_node(node)
        while True:
            began = time.monotonic()
            _call(client, executor, request, manner, deadline)
            if manner.rate is None:
                return
            _sleep(executor, began + 1.0 / manner.rate)
            deadline = time.monotonic() + manner.timeout


def _wait_for_type(context: Context, asked: Asked, manner: Manner, deadline: float) -> type[Any]:
    """Wait until the service is there, with the type that is named, if one is; give its class."""
    from robolink.cli.types import service_type

    if not _served(context, asked):
        _check_early(asked)
        if not manner.json:
            say("waiting for service to become available...")
        _wait(context, asked, manner, deadline)
    return service_type(context, asked.name, asked.type_)


def _check_early(asked: Asked) -> None:
    """Find what is wrong with the request before anybody waits for the service, where its type is installed."""
    if asked.type_:
        with contextlib.suppress(NotFoundError):  # the server may know it
            message_of(find(asked.type_, "srv").Request, asked.values)


def _served(context: Context, asked: Asked) -> bool:
    servers = context.graph.endpoints(EndpointKind.SERVICE, name=asked.name)
    return any(not asked.type_ or is_named(each.type_name, asked.type_) for each in servers)


def _wait(context: Context, asked: Asked, manner: Manner, deadline: float) -> None:
    patience = time.monotonic() + PATIENCE
    while not context.graph.wait_for(lambda: _served(context, asked) or not context.ok(), _SLICE):
        now = time.monotonic()
        if now >= deadline:
            raise CallError(f"gave up after {manner.timeout:g} s: {_why_absent(context, asked)}")
        if now >= patience:
            patience = float("inf")
            tell(f"waiting: {_why_absent(context, asked)}")
    if not context.ok():
        raise KeyboardInterrupt


def _why_absent(context: Context, asked: Asked) -> str:
    """Say why there is no such service."""
    served = context.graph.endpoints(EndpointKind.SERVICE)
    types = sorted({each.type_name for each in served if each.name == asked.name})
    if types:
        return f"{asked.name} is served as {' and '.join(types)}, not as {shown(asked.type_)}"
    elsewhere = hint(domains_with(context, asked.name, EndpointKind.SERVICE))
    near = "" if elsewhere else nearest(asked.name, sorted({each.name for each in served}))
    return f"nobody serves {asked.name} on domain {context.get_domain_id()}{elsewhere}{near}"


def _call(client: Client, executor: Executor, request: Any, manner: Manner, deadline: float) -> None:
    if not manner.json:
        say(f"requester: making request: {request!r}\n")
    future = client.try_call_async(request)
    _spin(executor, future, min(PATIENCE, deadline - time.monotonic()))
    if not future.done() and time.monotonic() < deadline:
        tell(f"waiting: {_server_of(executor, client)} has not answered yet")
        _spin(executor, future, deadline - time.monotonic())
    if not future.done():
        client.remove_pending_request(future)
        raise CallError(f"no answer within {manner.timeout:g} s from {_server_of(executor, client)}")
    response = future.result()
    if manner.json:
        say(show.as_json({"request": show.plain(request), "response": show.plain(response)}))
    else:
        say(f"response:\n{response!r}\n")


def _spin(executor: Executor, future: Any, seconds: float) -> None:
    executor.spin_until_future_complete(future, timeout_sec=max(0.0, seconds))
    if not executor.context.ok():
        raise KeyboardInterrupt


def _sleep(executor: Executor, until: float) -> None:
    from robolink.task import Future

    _spin(executor, Future[None](), until - time.monotonic())


def _server_of(executor: Executor, client: Client) -> str:
    """Name who serves, as far as is known."""
    found = executor.context.graph.endpoints(EndpointKind.SERVICE, name=client.srv_name)
    if not found:
        return f"{client.srv_name}, which nobody serves any more"
    return f"{client.srv_name} of {found[0].full_node_name}"
