"""Callbacks for changes of parameters, of any node: one parameter's, or all events."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable
from itertools import chain
from typing import TYPE_CHECKING, Any

from robolink.interfaces.rcl_interfaces.msg import Parameter, ParameterEvent
from robolink.node_parts.making import make_subscription
from robolink.qos import QoSProfile, qos_profile_parameter_events
from robolink.subscription import Subscription
from robolink.text.names import absolute_namespace, join

if TYPE_CHECKING:
    from robolink.callback_groups import CallbackGroup
    from robolink.event_handler import SubscriptionEventCallbacks
    from robolink.node import BaseNode
    from robolink.qos_overriding_options import QoSOverridingOptions


class ParameterCallbackHandle:
    """Handle of a callback for one parameter, by which it is removed.

    Args:
        parameter_name: Name of the parameter.
        node_name: Fully qualified name of its node.
        callback: Function of the parameter's message.
    """

    def __init__(self, parameter_name: str, node_name: str, callback: Callable[[Parameter], None]) -> None:
        self.parameter_name = parameter_name
        self.node_name = node_name
        self.callback = callback


class ParameterEventCallbackHandle:
    """Handle of a `callback` for all events, by which it is removed."""

    def __init__(self, callback: Callable[[ParameterEvent], None]) -> None:
        self.callback = callback


class ParameterEventHandler:
    """Calls back when parameters of any node change, by a subscription of /parameter_events.

        handler = ParameterEventHandler(node)
        handler.add_parameter_callback("speed", "driver", on_speed)

    The latest added is called first. A callback may add and remove callbacks, itself too; that counts from the next
    event on.

    Args:
        node: Node that subscribes, and whose executor must spin.
        qos_profile: Quality of service of the subscription.
        callback_group: Group of the callbacks; None is the node's default group.
        event_callbacks: Callbacks for events of the subscription.
        qos_overriding_options: Policies that parameters may change; None allows none.
        raw: As in rclpy: must be False, since the callbacks need the message.
    """

    class Callbacks:
        """Callbacks that were added."""

        def __init__(self) -> None:
            self.parameter_callbacks: dict[tuple[str, str], list[ParameterCallbackHandle]] = {}
            """Handles by the names of the parameter and of its node."""
            self.event_callbacks: list[ParameterEventCallbackHandle] = []
            self._lock = threading.Lock()

        def event_callback(self, event: ParameterEvent) -> None:
            """Call those whose parameter is in the `event`, as new or changed, then those for all events."""
            with self._lock:
                expected = [(key, list(handles)) for key, handles in self.parameter_callbacks.items()]
                for_all = list(self.event_callbacks)
            for (parameter_name, node_name), handles in expected:
                parameter = ParameterEventHandler.get_parameter_from_event(event, parameter_name, node_name)
                if parameter is not None:
                    for handle in handles:
                        handle.callback(parameter)
            for each in for_all:
                each.callback(event)

        def add_parameter_callback(
            self, parameter_name: str, node_name: str, callback: Callable[[Parameter], None]
        ) -> ParameterCallbackHandle:
            """Add `callback(parameter)` for the parameter `parameter_name` of the node of the full name `node_name`."""
            handle = ParameterCallbackHandle(parameter_name, node_name, callback)
            with self._lock:
                self.parameter_callbacks.setdefault((parameter_name, node_name), []).insert(0, handle)
            return handle

        def remove_parameter_callback(self, handle: ParameterCallbackHandle) -> None:
            """Remove the callback of this `handle`. Raises RuntimeError if it is not there."""
            key = (handle.parameter_name, handle.node_name)
            with self._lock:
                handles = self.parameter_callbacks.get(key, [])
                _remove(handle, handles)
                if not handles:
                    del self.parameter_callbacks[key]

        def add_parameter_event_callback(
            self, callback: Callable[[ParameterEvent], None]
        ) -> ParameterEventCallbackHandle:
            """Add `callback(event)` for each event."""
            handle = ParameterEventCallbackHandle(callback)
            with self._lock:
                self.event_callbacks.insert(0, handle)
            return handle

        def remove_parameter_event_callback(self, handle: ParameterEventCallbackHandle) -> None:
            """Remove the callback of this `handle`. Raises RuntimeError if it is not there."""
            with self._lock:
                _remove(handle, self.event_callbacks)

    def __init__(
        self,
        node: BaseNode,
        qos_profile: QoSProfile = qos_profile_parameter_events,
        callback_group: CallbackGroup | None = None,
        event_callbacks: SubscriptionEventCallbacks | None = None,
        qos_overriding_options: QoSOverridingOptions | None = None,
        raw: bool = False,
    ) -> None:
        self.node = node
        self.qos_profile = qos_profile
        self._callbacks = ParameterEventHandler.Callbacks()
        self.parameter_event_subscription = make_subscription(
            node,
            Subscription,
            ParameterEvent,
            "/parameter_events",
            self._callbacks.event_callback,
            qos_profile,
            callback_group or node._group_of_part_(),
            raw,
            events=event_callbacks,
            overriding=qos_overriding_options,
        )

    def destroy(self) -> None:
        """End the subscription: nothing is called any more."""
        self.node.destroy_subscription(self.parameter_event_subscription)

    @staticmethod
    def get_parameter_from_event(event: ParameterEvent, parameter_name: str, node_name: str) -> Parameter | None:
        """Return a parameter that is new or changed in an event; None if it is not in it.

        Args:
            event: Event to look at.
            parameter_name: Name of the parameter.
            node_name: Fully qualified name of its node.
        """
        if event.node != node_name:
            return None
        found = ParameterEventHandler.get_parameters_from_event(event)
        return next((each for each in found if each.name == parameter_name), None)

    @staticmethod
    def get_parameters_from_event(event: ParameterEvent) -> Iterable[Parameter]:
        """Yield all parameters that are new or changed in an `event`."""
        yield from chain(event.new_parameters, event.changed_parameters)

    def add_parameter_callback(
        self, parameter_name: str, node_name: str, callback: Callable[[Parameter], None]
    ) -> ParameterCallbackHandle:
        """Add a callback for one parameter, called when it is new or has changed.

        Args:
            parameter_name: Name of the parameter.
            node_name: Name of its node, relative to the namespace of this handler's node unless it begins with a
                slash; '' is that node.
            callback: Function of the parameter's message.

        Returns:
            A handle, by which the callback can be removed.
        """
        return self._callbacks.add_parameter_callback(parameter_name, self._resolve_path(node_name), callback)

    def remove_parameter_callback(self, handle: ParameterCallbackHandle) -> None:
        """Remove the callback of this `handle`. Raises RuntimeError if it is not there."""
        self._callbacks.remove_parameter_callback(handle)

    def add_parameter_event_callback(self, callback: Callable[[ParameterEvent], None]) -> ParameterEventCallbackHandle:
        """Add `callback(event)` for each event of any node; the handle that is returned removes it."""
        return self._callbacks.add_parameter_event_callback(callback)

    def remove_parameter_event_callback(self, handle: ParameterEventCallbackHandle) -> None:
        """Remove the callback of this `handle`. Raises RuntimeError if it is not there."""
        self._callbacks.remove_parameter_event_callback(handle)

    def _resolve_path(self, node_path: str | None = None) -> str:
        if not node_path:
            return self.node.get_fully_qualified_name()
        if node_path.startswith("/"):
            return node_path
        return join(absolute_namespace(self.node.get_namespace()), node_path)


def _remove(handle: Any, handles: list[Any]) -> None:
    if handle not in handles:
        raise RuntimeError("this callback is not there: it was removed before, or never added")
    handles.remove(handle)
