"""Calls of the services of running nodes, several at once, for commands that ask nodes something."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from robolink.cli.shared.session import node_of
from robolink.exceptions import RobolinkError, ServiceError
from robolink.executors import SingleThreadedExecutor
from robolink.system import clocks

if TYPE_CHECKING:
    from robolink.context import Context


def call_all(
    context: Context,
    srv_type: type[Any],
    requests: dict[str, Any],
    within: float,
    no_answer: Callable[[str], RobolinkError],
) -> dict[str, Any]:
    """Call services, all at once, and return the response of each, or its error, by the service's name.

    Args:
        context: Context in which a node of its own asks.
        srv_type: Type of the services.
        requests: Request by service.
        within: Timeout of all answers, in seconds.
        no_answer: Makes the error of a service that does not answer in time.
    """
    deadline = clocks.monotonic() + within
    with SingleThreadedExecutor(context=context) as executor:
        asker = node_of(context)
        executor.add_node(asker)
        futures = {name: asker.create_client(srv_type, name).try_call_async(each) for name, each in requests.items()}
        for future in futures.values():
            executor.spin_until_future_complete(future, timeout_sec=max(0.0, deadline - clocks.monotonic()))
            if not context.ok():
                raise KeyboardInterrupt
        answers = {name: _answer(name, future, no_answer) for name, future in futures.items()}
        asker.destroy_node()
    return answers


def _answer(service: str, future: Any, no_answer: Callable[[str], RobolinkError]) -> Any:
    if not future.done():
        return no_answer(service)
    try:
        return future.result()
    except ServiceError as error:
        return error
