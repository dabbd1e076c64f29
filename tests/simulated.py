"""Nodes around a simulated world: on a bus of their own, in virtual time."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from typing import Any

from robolink import Context, Node, Parameter, VirtualTime, logging
from robolink.executors import SingleThreadedExecutor

START = 1_000_000_000
NUMBERS = itertools.count()


class System:
    """Nodes of one process on a bus of their own, in virtual time; `log` has what they logged."""

    def __init__(self) -> None:
        self.context = Context(transport=f"memory://sim{next(NUMBERS)}", time=VirtualTime(START))
        self.context.init([])
        self.executor = SingleThreadedExecutor(context=self.context)
        self.probe = self.add(Node, node_name="probe")
        self.log = list[str]()
        logging.add_handler(self._note)

    def _note(self, record: logging.Record) -> None:
        self.log.append(record.message)

    def add(self, node_class: Callable[..., Any], parameters: dict[str, Any] | None = None, **options: Any) -> Any:
        overrides = [Parameter(name, value=value) for name, value in (parameters or {}).items()]
        node = node_class(context=self.context, parameter_overrides=overrides, **options)
        self.executor.add_node(node)
        return node

    def hear(self, message_class: type[Any], topic: str, qos: Any = 1000) -> list[Any]:
        heard = list[Any]()
        self.probe.create_subscription(message_class, topic, heard.append, qos)
        return heard

    def ask(self, srv_type: type[Any], name: str, /, **fields: Any) -> tuple[bool, str]:
        """Call a service; give its success and its message."""
        client = self.probe.create_client(srv_type, name)
        future = client.call_async(srv_type.Request(**fields))
        self.executor.spin_until_future_complete(future, timeout_sec=60.0)
        answer = future.result()
        self.probe.destroy_client(client)
        assert answer is not None, f"{name} did not answer"
        return answer.success, answer.message

    def run(self, seconds: float) -> None:
        end = self.context.time.now() + round(seconds * 1e9)
        timer = self.probe.create_timer(seconds, lambda: None)
        while self.context.time.now() < end:
            self.executor.spin_once()
        self.probe.destroy_timer(timer)

    def close(self) -> None:
        logging.remove_handler(self._note)
        for node in self.executor.get_nodes():
            node.destroy_node()
        self.executor.shutdown()
        self.context.shutdown()
