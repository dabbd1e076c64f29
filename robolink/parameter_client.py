"""The asking side of a node's parameters: reads, sets and describes those of another node."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from os import PathLike
from typing import TYPE_CHECKING, Any, TypeAlias

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
from robolink.parameter import Parameter as Parameter
from robolink.parameter import parameter_dict_from_yaml_file
from robolink.qos import QoSProfile, qos_profile_parameter_events, qos_profile_services_default
from robolink.task import Future

if TYPE_CHECKING:
    from robolink.callback_groups import CallbackGroup
    from robolink.client import Client
    from robolink.event_handler import SubscriptionEventCallbacks
    from robolink.node import Node
    from robolink.qos_overriding_options import QoSOverridingOptions
    from robolink.subscription import Subscription

Given: TypeAlias = Sequence["Parameter[Any] | ParameterMsg"]
Callback: TypeAlias = Callable[[Any], None]
"""Called with the future once it is done."""


class AsyncParameterClient:
    """Asks the parameter services of the node called `remote_node_name`, relative to the namespace of `node`.

        client = AsyncParameterClient(node, "turtlesim")
        future = client.set_parameters([Parameter("background_r", value=150)])

    Each question gives a future with the service's whole response, and calls `callback(future)` once that is there.
    """

    def __init__(
        self,
        node: Node,
        remote_node_name: str,
        qos_profile: QoSProfile = qos_profile_services_default,
        callback_group: CallbackGroup | None = None,
    ) -> None:
        self.remote_node_name = remote_node_name
        self.node = node

        def client(srv_type: type[Any], name: str) -> Client:
            full = f"{remote_node_name}/{name}"
            return node.create_client(srv_type, full, qos_profile=qos_profile, callback_group=callback_group)

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
        """Whether somebody serves all six."""
        return all(each.service_is_ready() for each in self._clients)

    def wait_for_services(self, timeout_sec: float | None = None) -> bool:
        """Wait until somebody serves all six; whether so within `timeout_sec` seconds, without end when None."""
        steady = self._clients[0]._context.time.steady
        deadline = None if timeout_sec is None else steady() + int(timeout_sec * 1e9)
        for each in self._clients:
            left = None if deadline is None else max(0, deadline - steady()) / 1e9
            if not each.service_is_ready() and not each.wait_for_service(left):
                return False
        return self.services_are_ready()

    def list_parameters(
        self, prefixes: list[str] | None = None, depth: int | None = None, callback: Callback | None = None
    ) -> Future[ListParameters.Response]:
        """Ask for names: those that are one of `prefixes` or up to `depth` dots below one; None is all of them."""
        request = ListParameters.Request(prefixes=prefixes or [], depth=depth or 0)
        return _ask(self._list_parameter_client, request, callback)

    def get_parameters(self, names: list[str], callback: Callback | None = None) -> Future[GetParameters.Response]:
        """Ask for values. There are none at all in the answer when one of the names is unknown or has no value."""
        return _ask(self._get_parameter_client, GetParameters.Request(names=names), callback)

    def set_parameters(self, parameters: Given, callback: Callback | None = None) -> Future[SetParameters.Response]:
        """Have parameters set one by one; the answer has a result for each."""
        request = SetParameters.Request(parameters=_messages(parameters))
        return _ask(self._set_parameter_client, request, callback)

    def describe_parameters(
        self, names: list[str], callback: Callback | None = None
    ) -> Future[DescribeParameters.Response]:
        """Ask for descriptors. There are none at all in the answer when one of the names is unknown."""
        return _ask(self._describe_parameters_client, DescribeParameters.Request(names=names), callback)

    def get_parameter_types(
        self, names: list[str], callback: Callback | None = None
    ) -> Future[GetParameterTypes.Response]:
        """Ask for the types of values, as numbers of `Parameter.Type`."""
        return _ask(self._get_parameter_types_client, GetParameterTypes.Request(names=names), callback)

    def set_parameters_atomically(
        self, parameters: Given, callback: Callback | None = None
    ) -> Future[SetParametersAtomically.Response]:
        """Have all these parameters set, or none."""
        request = SetParametersAtomically.Request(parameters=_messages(parameters))
        return _ask(self._set_parameters_atomically_client, request, callback)

    def delete_parameters(self, names: list[str], callback: Callback | None = None) -> Future[SetParameters.Response]:
        """Have parameters undeclared; only those of dynamic type can be."""
        return self.set_parameters([Parameter(name) for name in names], callback)

    def load_parameter_file(
        self, parameter_file: str | PathLike[str], use_wildcard: bool = False, callback: Callback | None = None
    ) -> Future[SetParameters.Response]:
        """Have all parameters of a file set, whichever nodes it has them for; `use_wildcard` adds those of ``/**``.

        Raises what `parameter_dict_from_yaml_file` raises.
        """
        return self.set_parameters(_of_file(parameter_file, use_wildcard), callback)

    def load_parameter_file_atomically(
        self, parameter_file: str | PathLike[str], use_wildcard: bool = False, callback: Callback | None = None
    ) -> Future[SetParametersAtomically.Response]:
        """Have all parameters of a file set, or none; see `load_parameter_file`."""
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
        """Subscribe to the changes of all nodes' parameters; a ParameterEvent says of which node it is."""
        return self.node.create_subscription(
            ParameterEvent,
            "/parameter_events",
            callback,
            qos_profile,
            callback_group=callback_group,
            event_callbacks=event_callbacks,
            qos_overriding_options=qos_overriding_options,
            raw=raw,
        )


def _ask(client: Client, request: Any, callback: Callback | None) -> Future[Any]:
    future = client.call_async(request)
    if callback is not None:
        future.add_done_callback(callback)
    return future


def _messages(parameters: Given) -> list[ParameterMsg]:
    return [each.to_parameter_msg() if isinstance(each, Parameter) else each for each in parameters]


def _of_file(path: str | PathLike[str], use_wildcard: bool) -> list[ParameterMsg]:
    return list(parameter_dict_from_yaml_file(path, use_wildcard).values())
