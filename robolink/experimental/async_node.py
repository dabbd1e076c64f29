"""AsyncNode: a node that runs on asyncio's event loop, without an executor."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Coroutine, Generator
from types import TracebackType
from typing import TYPE_CHECKING, Any, Generic, TypeVar, cast

from robolink.callback_groups import CallbackGroup, MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from robolink.clock_type import ClockType
from robolink.exceptions import ExternalShutdownException, NotInitializedException
from robolink.experimental.async_client import AsyncClient
from robolink.experimental.async_clock import AsyncClock
from robolink.experimental.async_publisher import AsyncPublisher
from robolink.experimental.async_service import AsyncService
from robolink.experimental.async_subscription import AsyncSubscription
from robolink.experimental.async_timer import AsyncTimer
from robolink.experimental.groups import TaskGroup
from robolink.experimental.loops import call_at
from robolink.experimental.pump import Pump
from robolink.node import BaseNode
from robolink.node_parts.making import make_client, make_publisher, make_service, make_subscription
from robolink.qos import QoSProfile, qos_profile_services_default
from robolink.running.defaults import get_defaults
from robolink.running.entity import ANY_TIME
from robolink.timer import period_ns
from robolink.type_support import MsgT

if TYPE_CHECKING:
    from robolink.subscription_content_filter_options import ContentFilterOptions
    from robolink.task import Future


T = TypeVar("T")

LOOK = 0.1
"""Time between two looks at the graph, in seconds."""


class Awaited(Generic[T]):
    """Result that is to be awaited, of a method that returns it at once to a node in a thread.

    Args:
        work: Coroutine that finds it.
    """

    def __init__(self, work: Coroutine[Any, Any, T]) -> None:
        self._work = work

    def __await__(self) -> Generator[Any, None, T]:
        return self._work.__await__()

    def __bool__(self) -> bool:
        self._work.close()
        raise TypeError("await this wait first, since its node is an AsyncNode: `if await client.wait_for_server():`")


class AsyncNode(BaseNode):
    """Node whose callbacks are tasks of the running event loop of asyncio.

        async with AsyncNode("talker") as node:
            publisher = node.create_publisher(String, "chatter", 10)
            while True:
                publisher.publish(String(data="hello"))
                await node.get_clock().sleep(0.5)

    It runs within `async with node:`, or while `node.run()` is awaited, once. Both destroy it at their end, and cancel
    its callbacks under way. An exception of a callback ends it too: the others are cancelled, what the block awaits is
    cancelled, and the block raises an ExceptionGroup. No executor spins it. Its arguments, and what it raises, are
    those of `Node`; it may be made before there is an event loop.
    """

    _runs_itself_ = True

    def _init_own_(self) -> None:
        super()._init_own_()
        self._ended_ = asyncio.Event()
        """Set at the end of the node."""
        self._pump_: Pump | None = None
        self._group_: TaskGroup | None = None
        self._entered_by_: asyncio.Task[Any] | None = None
        self._is_interrupted_ = self._is_in_main_thread_ = False

    def _make_clock_(self) -> AsyncClock:
        return AsyncClock(clock_type=ClockType.ROS_TIME, time_base=self._context.time)

    def _in_group_(self, group: CallbackGroup) -> dict[str, Any]:
        return {"concurrent": isinstance(group, ReentrantCallbackGroup)}

    def _group_of_part_(self) -> CallbackGroup:
        return MutuallyExclusiveCallbackGroup()

    def get_clock(self) -> AsyncClock:
        """Return the node's clock, whose `sleep` is awaited; it follows /clock while `use_sim_time` is true."""
        clock: AsyncClock = self._clock  # type: ignore[assignment]
        return clock

    # Running

    async def __aenter__(self) -> AsyncNode:
        self._check_("node")
        name = self.get_fully_qualified_name()
        if self._group_ is not None:
            raise RuntimeError(f"node {name} is already running: enter it once, by `async with` or by `run()`")
        if not self._context.ok():
            raise NotInitializedException(f"cannot run node {name}", ended_by=self._context.ended_by)
        group = TaskGroup()
        self._group_ = await group.__aenter__()
        self._entered_by_ = asyncio.current_task()
        self._is_in_main_thread_ = get_defaults().in_main_thread()
        self._context.given_parameters.warn_of_typos([self])
        self._context.on_shutdown(self._on_context_end_)
        self._pump_ = Pump(self, group)
        return self

    async def __aexit__(
        self, exc_type: type[BaseException] | None, exc_val: BaseException | None, exc_tb: TracebackType | None
    ) -> None:
        group, task = self._group_, self._entered_by_
        assert group is not None
        if exc_type is GeneratorExit:  # the loop went away in the middle of it: nothing can be awaited
            return self.destroy_node()
        try:
            self.destroy_node()
        finally:
            try:
                await group.__aexit__(exc_type, exc_val, exc_tb)
            except (KeyboardInterrupt, SystemExit):
                if not isinstance(exc_val, asyncio.CancelledError):
                    raise  # else it came out of a callback, and has left the event loop by itself
            finally:
                self._group_ = self._pump_ = self._entered_by_ = None
                if self._is_interrupted_ and task is not None and isinstance(exc_val, asyncio.CancelledError):
                    self._raise_interrupt_(task)

    async def run(self) -> None:
        """Run the node until `destroy_node` is called, or the context is shut down.

        Raises:
            RuntimeError: if the node runs already, or has been destroyed.
            ExceptionGroup: of what a callback raises.
        """
        async with self:
            await self._ended_.wait()

    def _on_context_end_(self) -> None:
        """End the running at Ctrl-C or SIGTERM in another thread than the main one, which alone hears of them."""
        pump = self._pump_
        if pump is not None and self._context.interrupted and not self._is_in_main_thread_:
            call_at(pump.loop, self._interrupt_)

    def _interrupt_(self) -> None:
        if self._entered_by_ is not None and self._pump_ is not None:
            self._is_interrupted_ = True
            self._entered_by_.cancel()

    def _raise_interrupt_(self, task: asyncio.Task[Any]) -> None:
        """Raise what `spin` raises, in place of the cancellation by which `_interrupt_` got here."""
        uncancel = getattr(task, "uncancel", None)  # since Python 3.11
        if uncancel is not None:
            uncancel()
        raise ExternalShutdownException from None

    def destroy_node(self) -> None:
        """Destroy the node and all that it has, and cancel its callbacks under way. Safe to call twice."""
        if self._destroyed:
            return
        pump = self._pump_
        super().destroy_node()
        self.get_clock().destroy()
        if pump is None or (pump.spins_here and not pump.loop.is_closed()):
            self._ended_.set()
        else:
            call_at(pump.loop, self._ended_.set)

    def _wait_until_(self, holds: Callable[[], bool], timeout_sec: float | None) -> Awaited[bool]:
        return Awaited(self._look_until_(holds, timeout_sec))

    async def _look_until_(self, holds: Callable[[], bool], timeout_sec: float | None) -> bool:
        steady = self._context.time.steady
        deadline = None if timeout_sec is None else steady() + int(timeout_sec * 1e9)
        while not holds():
            left = LOOK if deadline is None else min(LOOK, (deadline - steady()) / 1e9)
            if left <= 0 or not self._context.ok():
                return False
            await asyncio.sleep(left)
        return True

    def _abandon_(self, future: Future[Any]) -> None:
        if not future.over():
            future.set_exception(asyncio.CancelledError())
            future.exception()  # else it would be reported if nobody awaits it

    async def wait_for_node(self, fully_qualified_node_name: str, *, check_interval: float = 0.1) -> None:
        """Wait until a node is in the graph; end the wait by `asyncio.timeout`.

        Args:
            fully_qualified_node_name: Namespace and name of the node; a missing leading slash is added.
            check_interval: Time between two looks, in seconds.

        Raises:
            InvalidHandle: (a RuntimeError) if this node has been destroyed.
        """
        namespace, _, name = ("/" + fully_qualified_node_name.lstrip("/")).rpartition("/")
        while not self._graph_.has_node(name, namespace or "/"):
            await asyncio.sleep(check_interval)

    # Creating

    def create_publisher(self, msg_type: type[MsgT], topic: str, qos_profile: QoSProfile | int) -> AsyncPublisher[MsgT]:
        """Create a publisher of a topic.

        Args:
            msg_type: Message class of the topic, such as `std_msgs.msg.String`.
            topic: Name of the topic, relative to the node's namespace unless it begins with a slash; remapped.
            qos_profile: Quality of service; a number is the depth of a reliable, volatile KEEP_LAST profile.

        Raises:
            InvalidTopicNameException: (a ValueError) if the name is against ROS 2's rules.
            MessageError: (a ValueError) if `msg_type` is not a message class.
            InvalidHandle: (a RuntimeError) if the node has been destroyed.
        """
        self._check_("node")
        return make_publisher(self, AsyncPublisher, msg_type, topic, qos_profile, ANY_TIME)

    def create_subscription(
        self,
        msg_type: type[MsgT],
        topic: str,
        callback: Callable[..., Any],
        qos_profile: QoSProfile | int,
        *,
        raw: bool = False,
        concurrent: bool = False,
        content_filter_options: ContentFilterOptions | None = None,
    ) -> AsyncSubscription[MsgT]:
        """Create a subscription of a topic.

        Args:
            msg_type: Message class of the topic.
            topic: Name of the topic, relative to the node's namespace unless it begins with a slash; remapped.
            callback: Function, or coroutine function, called with each message; if it takes two arguments, with the
                message and its MessageInfo.
            qos_profile: Quality of service; a number is the depth of a reliable, volatile KEEP_LAST profile. The
                depth is how many messages wait for the callback before the oldest is dropped.
            raw: True calls back with the serialized message (bytes) instead.
            concurrent: True calls back for each message as it comes, while earlier calls still await something;
                False waits for the end of the call before.
            content_filter_options: Filter for messages. It has no effect here, as with rmw_zenoh: a warning says so.

        Raises:
            InvalidTopicNameException: (a ValueError) if the name is against ROS 2's rules.
            MessageError: (a ValueError) if `msg_type` is not a message class.
            RuntimeError: if the callback takes neither one argument nor two.
            InvalidHandle: (a RuntimeError) if the node has been destroyed.
        """
        self._check_("node")
        args = msg_type, topic, callback, qos_profile, _gate(concurrent), raw, content_filter_options
        return make_subscription(self, AsyncSubscription, *args)

    def create_service(
        self,
        srv_type: type[Any],
        srv_name: str,
        callback: Callable[[Any, Any], Any],
        *,
        qos_profile: QoSProfile = qos_profile_services_default,
        concurrent: bool = False,
    ) -> AsyncService:
        """Create a service: serve requests under a name.

        Args:
            srv_type: Service class, such as `std_srvs.srv.SetBool`.
            srv_name: Name of the service, relative to the node's namespace unless it begins with a slash; remapped.
            callback: Function, or coroutine function, called as `callback(request, response)` with an empty response;
                it returns the response to send.
            qos_profile: Quality of service; by default reliable with a depth of 10.
            concurrent: True calls back for each request as it comes, while earlier calls still await something; False
                waits for the end of the call before.

        Raises:
            InvalidServiceNameException: (a ValueError) if the name is against ROS 2's rules.
            MessageError: (a ValueError) if `srv_type` is not a service class.
            InvalidHandle: (a RuntimeError) if the node has been destroyed.
        """
        self._check_("node")
        return make_service(self, AsyncService, srv_type, srv_name, callback, qos_profile, _gate(concurrent))

    def create_client(
        self, srv_type: type[Any], srv_name: str, *, qos_profile: QoSProfile = qos_profile_services_default
    ) -> AsyncClient:
        """Create a client, which calls a service.

        Args:
            srv_type: Service class, such as `std_srvs.srv.SetBool`.
            srv_name: Name of the service, relative to the node's namespace unless it begins with a slash; remapped.
            qos_profile: Quality of service; by default reliable with a depth of 10.

        Raises:
            InvalidServiceNameException: (a ValueError) if the name is against ROS 2's rules.
            MessageError: (a ValueError) if `srv_type` is not a service class.
            InvalidHandle: (a RuntimeError) if the node has been destroyed.
        """
        self._check_("node")
        return make_client(self, AsyncClient, srv_type, srv_name, qos_profile, ANY_TIME)

    def create_timer(self, timer_period_sec: float, callback: Callable[..., Any], autostart: bool = True) -> AsyncTimer:
        """Create a timer, which calls a function periodically, by the node's clock.

        Args:
            timer_period_sec: Period in seconds, 0 or more; 0 calls as often as possible.
            callback: Function, or coroutine function, without arguments, or with one, a TimerInfo.
            autostart: False makes the timer cancelled; `timer.reset()` starts it.

        Raises:
            ValueError: if the period is negative, infinite or not a number.
            TypeError: if the callback cannot be called; RuntimeError if it needs more than one argument.
            InvalidHandle: (a RuntimeError) if the node has been destroyed.
        """
        self._check_("node")
        period = period_ns(timer_period_sec)
        timer = AsyncTimer(callback, _gate(False), period, self._clock, context=self._context, autostart=autostart)
        return self._entity_store_.add(timer, cast("list[AsyncTimer]", self._entity_store_.timers))


def _gate(concurrent: bool) -> CallbackGroup:
    """Return the group of one entity, whose callbacks run side by side or one at a time."""
    return ReentrantCallbackGroup() if concurrent else MutuallyExclusiveCallbackGroup()
