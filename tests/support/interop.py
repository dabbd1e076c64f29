"""Helpers for interoperability tests: a Zenoh router, and a robolink node that joins it as it joins `rmw_zenohd`."""

from __future__ import annotations

import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TypeVar, cast

import pytest

from robolink import Context, Future, Node
from robolink.cli.doctor import gathering
from robolink.executors import SingleThreadedExecutor
from robolink.networks import settings
from robolink.transport import joining
from robolink.transport.zenoh import ZenohTransport

PATIENCE = 30.0


T = TypeVar("T")


class Robot(Node):
    """A node with an executor of its own and a session in which it is alone."""

    executor_of_its_own: SingleThreadedExecutor

    def spin_until(self, condition: Callable[[], bool]) -> None:
        """Spin until it holds."""
        deadline = time.monotonic() + PATIENCE
        while not condition():
            assert time.monotonic() < deadline, "it did not come true"
            self.executor_of_its_own.spin_once(timeout_sec=0.02)

    def while_spinning(self, action: Callable[[], T]) -> T:
        """Do something in another thread while this one spins; give what it gives."""
        future: Future[T] = Future()

        def act() -> None:
            try:
                future.set_result(action())
            except BaseException as error:
                future.set_exception(error)

        thread = threading.Thread(target=act)
        thread.start()
        self.spin_until(future.done)
        thread.join()
        return cast(T, future.result())


def put_router_at(patch: pytest.MonkeyPatch, port: int) -> None:
    """Let sessions look for ROS 2's router at this port."""
    for module in (joining, settings, gathering):
        patch.setattr(module, "ROS_ROUTER", f"tcp/127.0.0.1:{port}")


@contextmanager
def robot(port: int, domain: int, name: str = "robot", namespace: str = "", *, plain: bool = False) -> Iterator[Robot]:
    """A node in a context of its own on the usual network of this machine, where ROS 2's router is at this port."""
    with pytest.MonkeyPatch.context() as patch:
        put_router_at(patch, port)
        asked = f"tcp/127.0.0.1:{port}" if sys.platform == "win32" else None  # there it has to be asked for
        session = ZenohTransport(domain, asked, environ={})
    with robot_on(session, domain, name, namespace, plain=plain) as node:
        yield node


@contextmanager
def robot_on(
    session: ZenohTransport, domain: int, name: str = "robot", namespace: str = "", *, plain: bool = False
) -> Iterator[Robot]:
    """A node on a session; with parameter services and /rosout if it is plain."""
    context = Context(transport=session)
    context.init([], domain_id=domain)
    with context, SingleThreadedExecutor(context=context) as executor:
        node = Robot(name, context=context, namespace=namespace, enable_rosout=plain, start_parameter_services=plain)
        node.executor_of_its_own = executor
        executor.add_node(node)
        yield node


def until(condition: Callable[[], object], seen: Callable[[], str] = lambda: "it did not come true") -> None:
    """Wait until it holds; else say what was seen."""
    deadline = time.monotonic() + PATIENCE
    while not condition():
        assert time.monotonic() < deadline, seen()
        time.sleep(0.002)
