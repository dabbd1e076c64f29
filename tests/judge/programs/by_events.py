"""Runs a program with an EventsExecutor in place of each other executor: `by_events.run("services")`.

In the wheels of rclpy 7.1.6 and 9.1.2 an EventsExecutor that waits without a timeout runs nothing, and does not end:
here such a wait has one of an hour, so that there is something to compare.
"""

import functools
import runpy
import sys

import rclpy
import rclpy.executors
from rclpy.experimental import EventsExecutor

HOUR = 3600.0


def _with_timeout(method, index):
    """A method whose timeout, its argument of that index, is an hour if it is None or less than 0."""

    def call(self, *args, timeout_sec=None, **kwargs):
        given = args[index] if len(args) > index else timeout_sec
        if given is None or (isinstance(given, (int, float)) and given < 0):
            given = HOUR
        return method(self, *args[:index], given, **kwargs)

    return call


def _patch(kind):
    once, until = kind.spin_once, kind.spin_until_future_complete
    kind.spin_once = _with_timeout(once, 0)
    kind.spin_until_future_complete = _with_timeout(until, 1)
    kind.spin = lambda self: until(self, rclpy.Future(), HOUR)


@functools.cache
def _patch_once(kind):
    _patch(kind)


def made(num_threads=None, *, context=None):
    """An EventsExecutor."""
    executor = EventsExecutor(context=context)
    _patch_once(type(executor))
    return executor


_shared = []


def _default(executor):
    if executor is not None:
        return executor
    if not (_shared and _shared[0].context.ok()):
        _shared[:] = [made()]
    return _shared[0]


def install():
    rclpy.executors.SingleThreadedExecutor = rclpy.executors.MultiThreadedExecutor = made
    spin, once, until = rclpy.spin, rclpy.spin_once, rclpy.spin_until_future_complete
    rclpy.spin = lambda node, executor=None: spin(node, _default(executor))
    rclpy.spin_once = lambda node, *, executor=None, timeout_sec=None: once(
        node, executor=_default(executor), timeout_sec=timeout_sec
    )
    rclpy.spin_until_future_complete = lambda node, future, executor=None, timeout_sec=None: until(
        node, future, _default(executor), timeout_sec
    )


def run(name):
    """Run a program that lies beside this one, as the main one."""
    install()
    runpy.run_path(sys.path[0] + f"/{name}.py", run_name="__main__")
