"""Client of another node's parameters: reads, sets and describes them by its services."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from os import PathLike
from typing import TYPE_CHECKING, Any, TypeAlias

from robolink.client import Client
from robolink.exceptions import InvalidHandle
from robolink.interfaces.rcl_interfaces.msg import Parameter as ParameterMsg
from robolink.interfaces.rcl_interfaces.msg import ParameterEvent
from robolink.interfaces.rcl_interfaces.srv import (
    DescribeParameters,
    GetParameters,
    GetParameterTypes,
    ListParameters,
    SetParameters,
    SetParametersAtomically,
)
from robolink.node_parts.making import make_client, make_subscription
from robolink.parameter import Parameter as Parameter
from robolink.parameter import parameter_dict_from_yaml_file
from robolink.qos import QoSProfile, qos_profile_parameter_events, qos_profile_services_default
from robolink.subscription import Subscription
from robolink.task import Future

if TYPE_CHECKING:
    from robolink.callback_groups import CallbackGroup
    from robolink.event_handler import SubscriptionEventCallbacks
    from robolink.node import BaseNode
    from robolink.qos_overriding_options import QoSOverridingOptions

Given: TypeAlias = Sequence["Parameter[Any] | ParameterMsg"]
Callback: TypeAlias = Callable[[Any], None]
"""Function that is called with the future once it is done."""


class AsyncParameterClient:
    """Client of the six parameter services of another node.

        client = AsyncParameterClient(node, "turtlesim")
        future = client.set_parameters([Parameter("background_r", value=150)])

    Each call returns a future of the service's whole response, and calls `callback(future)` once that is there.

    Args:
        node: BaseNode that calls, and whose executor must spin.
        remote_node_name: Name of the other node, relative to the namespace of `node` unless it begins with a slash.
        qos_profile: Quality of service of the clients.
        callback_group: Group of the clients; None is the node's default group.
    """

    def __init__(
        self,
        node: BaseNode,
        remote_node_name: str,
        qos_profile: QoSProfile = qos_profile_services_default,
        callback_group: CallbackGroup | None = None,
    ) -> None:
        self.remote_node_name = remote_node_name
        self.node = node

        def client(srv_type: type[Any], name: str) -> Client:
            full = f"{remote_node_name}/{name}"
            return make_client(node, Client, srv_type, full, qos_profile, callback_group or node._group_of_part_())

        self._get_parameter_client = client(GetParameters, "get_parameters")
        self._list_parameter_client = client(ListParameters, "list_parameters")
        self._set_parameter_client = client(SetParameters, "set_parameters")
        self._get_parameter_types_client = client(GetParameterTypes, "get_parameter_types")
        self._describe_parameters_client = client(DescribeParameters, "describe_parameters")
        self._set_parameters_atomically_client = client(SetParametersAtomically, "set_parameters_atomically")
        self._clients = (
            self._get_parameter_client,
            self._list_parameter_client,
            self._set_parameter_client,
            self._get_parameter_types_client,
            self._describe_parameters_client,
            self._set_parameters_atomically_client,
        )

    def services_are_ready(self) -> bool:
        """True if all six services are there."""
        return all(each.service_is_ready() for each in self._clients)

    def _are_there(self) -> bool:
        try:
            return self.services_are_ready()
        except InvalidHandle:
            if self.node.context.ok():
                raise
            return False  # the context ended between two looks, and destroyed the clients

    def wait_for_services(self, timeout_sec: float | None = None) -> Any:
        """Wait until all six services are there; of an AsyncNode it is awaited.

        Args:
            timeout_sec: Longest wait in seconds; None waits for ever, 0 or less does not wait.

        Returns:
            True if all are there.
        """
        return self.node._wait_until_(self._are_there, timeout_sec)

    def list_parameters(
        self, prefixes: list[str] | None = None, depth: int | None = None, callback: Callback | None = None
    ) -> Future[ListParameters.Response]:
        """Request the names of parameters.

        Args:
            prefixes: Names of parameters, or what their names begin with (without the dot); None lists all.
            depth: Largest number of dots below a prefix; None or 0 is any number.
            callback: Function called with the future once it is done.
        """
        request = ListParameters.Request(prefixes=prefixes or [], depth=depth or 0)
        return _ask(self._list_parameter_client, request, callback)

    def get_parameters(self, names: list[str], callback: Callback | None = None) -> Future[GetParameters.Response]:
        """Request the values of the parameters `names`; `callback(future)` is called with the response.

        The response has no values at all if one of the parameters is unknown or has none.
        """
        return _ask(self._get_parameter_client, GetParameters.Request(names=names), callback)

    def set_parameters(self, parameters: Given, callback: Callback | None = None) -> Future[SetParameters.Response]:
        """Request that `parameters` are set one by one; `callback(future)` is called with a result for each."""
        request = SetParameters.Request(parameters=_messages(parameters))
        return _ask(self._set_parameter_client, request, callback)

    def describe_parameters(
        self, names: list[str], callback: Callback | None = None
    ) -> Future[DescribeParameters.Response]:
        """Request the descriptors of the parameters `names`; `callback(future)` is called with the response.

        The response has no descriptors at all if one of the parameters is unknown.
        """
        return _ask(self._describe_parameters_client, DescribeParameters.Request(names=names), callback)

    def get_parameter_types(
        self, names: list[str], callback: Callback | None = None
    ) -> Future[GetParameterTypes.Response]:
        """Request the types of the parameters `names`, as numbers of `Parameter.Type`, for `callback(future)`."""
        return _ask(self._get_parameter_types_client, GetParameterTypes.Request(names=names), callback)

    def set_parameters_atomically(
        self, parameters: Given, callback: Callback | None = None
    ) -> Future[SetParametersAtomically.Response]:
        """Request that all `parameters` are set, or none; `callback(future)` is called with the result."""
        request = SetParametersAtomically.Request(parameters=_messages(parameters))
        return _ask(self._set_parameters_atomically_client, request, callback)

    def delete_parameters(self, names: list[str], callback: Callback | None = None) -> Future[SetParameters.Response]:
        """Request that the parameters `names` are undeclared; only those of dynamic type can be.

        `callback(future)` is called with a result for each.
        """
        return self.set_parameters([Parameter(name) for name in names], callback)

    def load_parameter_file(
        self, parameter_file: str | PathLike[str], use_wildcard: bool = False, callback: Callback | None = None
    ) -> Future[SetParameters.Response]:
        """Request that all parameters of a file are set one by one, whichever nodes it has them for.

        Args:
            parameter_file: Path of a ROS parameter file.
            use_wildcard: True adds the parameters of the section `/**`.
            callback: Function called with the future once it is done.

        Raises what `parameter_dict_from_yaml_file` raises.
        """
        return self.set_parameters(_of_file(parameter_file, use_wildcard), callback)

    def load_parameter_file_atomically(
        self, parameter_file: str | PathLike[str], use_wildcard: bool = False, callback: Callback | None = None
    ) -> Future[SetParametersAtomically.Response]:
        """Request that all parameters of a file are set, or none; see `load_parameter_file`.

        Args:
            parameter_file: Path of a ROS parameter file.
            use_wildcard: True adds the parameters of the section `/**`.
            callback: Function called with the future once it is done.
        """
        return self.set_parameters_atomically(_of_file(parameter_file, use_wildcard), callback)

    def on_parameter_event(
        self,
        callback: Callable[..., Any],
        qos_profile: QoSProfile = qos_profile_parameter_events,
        *,
        callback_group: CallbackGroup | None = None,
        event_callbacks: SubscriptionEventCallbacks | None = None,
        qos_overriding_options: QoSOverridingOptions | None = None,
        raw: bool = False,
    ) -> Subscription[ParameterEvent]:
        """Subscribe to the changes of all nodes' parameters.

        Args:
            callback: Function called with each ParameterEvent, which names its node.
            qos_profile: Quality of service of the subscription.
            callback_group: Group of the callback; None is the node's default group.
            event_callbacks: Callbacks for events of the subscription.
            qos_overriding_options: Policies that parameters may change; None allows none.
            raw: True calls back with the serialized message (bytes).
        """
        group = callback_group or self.node._group_of_part_()
        more = raw, None, event_callbacks, qos_overriding_options
        args = ParameterEvent, "/parameter_events", callback, qos_profile, group, *more
        return make_subscription(self.node, Subscription, *args)


def _ask(client: Client, request: Any, callback: Callback | None) -> Future[Any]:
    future = client.call_async(request)
    if callback is not None:
        future.add_done_callback(callback)
    return future


def _messages(parameters: Given) -> list[ParameterMsg]:
    return [each.to_parameter_msg() if isinstance(each, Parameter) else each for each in parameters]


def _of_file(path: str | PathLike[str], use_wildcard: bool) -> list[ParameterMsg]:
    return list(parameter_dict_from_yaml_file(path, use_wildcard).values())
