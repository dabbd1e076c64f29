"""Protocols of the node as its own parts and services see it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any, Protocol

if TYPE_CHECKING:
    from robolink.callback_groups import CallbackGroup
    from robolink.client import BaseClient
    from robolink.exceptions import InvalidHandle
    from robolink.executors import Executor
    from robolink.graph.endpoint import Owner
    from robolink.impl.rcutils_logger import RcutilsLogger
    from robolink.interfaces.rcl_interfaces.msg import (
        ListParametersResult,
        ParameterDescriptor,
        SetParametersResult,
    )
    from robolink.node_parts.entities import EntityStore
    from robolink.node_parts.parameters import OnSetCallback
    from robolink.parameter import Parameter
    from robolink.publisher import Publisher
    from robolink.qos import QoSProfile
    from robolink.running.ports import ContextLike, NodeLike
    from robolink.service import Service
    from robolink.subscription import Subscription
    from robolink.waitable import Waitable


class OwningNode(NodeLike, Protocol):
    """Node as seen by the store of its entities."""

    _destroyed: bool

    @property
    def _attached_to_(self) -> Executor | None:
        """The executor that the node's entities are attached to."""

    def _gone_(self, name: str) -> InvalidHandle:
        """Return the error for whoever uses it after its end."""


class ServingNode(Protocol):
    """Node as seen by a service of its own."""

    @property
    def context(self) -> ContextLike:
        """The context that it lives in."""

    def get_name(self) -> str:
        """Return its name, without the namespace."""

    def get_logger(self) -> RcutilsLogger:
        """Return the logger that carries the node's name."""

    def create_service(
        self,
        srv_type: type[Any],
        srv_name: str,
        callback: Callable[[Any, Any], Any],
        *,
        qos_profile: QoSProfile = ...,
        callback_group: CallbackGroup | None = None,
    ) -> Service:
        """Make a service."""

    def _in_group_(self, group: CallbackGroup) -> dict[str, Any]:
        """Return the arguments by which its `create_...` let a callback run in a group."""

    def destroy_service(self, service: Service) -> bool:
        """Undeclare a service."""


class DeclaringNode(ServingNode, Protocol):
    """Node as seen by a part that declares a parameter of its own."""

    def has_parameter(self, name: str) -> bool:
        """True if it is declared."""

    def declare_parameter(self, name: str, value: Any, descriptor: ParameterDescriptor | None = None) -> Parameter[Any]:
        """Declare a parameter."""

    def get_parameter(self, name: str) -> Parameter[Any]:
        """Return a parameter."""


class TypedNode(DeclaringNode, Protocol):
    """Node as seen by the service that describes the types of all it has."""

    @property
    def publishers(self) -> Iterator[Publisher[Any]]:
        """Its publishers."""

    @property
    def subscriptions(self) -> Iterator[Subscription[Any]]:
        """Its subscriptions."""

    @property
    def services(self) -> Iterator[Service]:
        """Its services."""

    @property
    def clients(self) -> Iterator[BaseClient]:
        """Its clients."""

    @property
    def waitables(self) -> Iterator[Waitable]:
        """Its actions."""


class TimedNode(DeclaringNode, Protocol):
    """Node as seen by its time source."""

    def create_subscription(
        self,
        msg_type: type[Any],
        topic: str,
        callback: Callable[..., Any],
        qos_profile: QoSProfile,
        *,
        callback_group: CallbackGroup | None = None,
    ) -> Subscription[Any]:
        """Make a subscription."""

    def destroy_subscription(self, subscription: Subscription[Any]) -> bool:
        """Undeclare a subscription."""

    def add_on_set_parameters_callback(self, callback: OnSetCallback) -> None:
        """Ask this callback before parameters are set."""

    def remove_on_set_parameters_callback(self, callback: OnSetCallback) -> None:
        """Ask it no more."""


class ParameterNode(ServingNode, Protocol):
    """Node as seen by the services of its parameters."""

    _allow_undeclared_parameters: bool
    _pre_set_parameters_callbacks: list[Any]

    def has_parameter(self, name: str) -> bool:
        """True if it is declared."""

    def get_parameters(self, names: list[str]) -> list[Parameter[Any]]:
        """Return parameters."""

    def get_parameter_or(self, name: str, alternative_value: Parameter[Any] | None = None) -> Parameter[Any]:
        """Return a parameter, or another one where there is none."""

    def get_parameters_by_prefix(self, prefix: str) -> dict[str, Parameter[Any]]:
        """Return the parameters below a prefix."""

    def get_parameter_types(self, names: list[str]) -> list[Parameter.Type]:
        """Return the types of parameters."""

    def describe_parameters(self, names: list[str]) -> list[ParameterDescriptor]:
        """Return the descriptors of parameters."""

    def list_parameters(self, prefixes: list[str], depth: int) -> ListParametersResult:
        """Return the names of parameters."""

    def set_parameters_atomically(self, parameter_list: list[Parameter[Any]]) -> SetParametersResult:
        """Set all or none."""


class MakingNode(OwningNode, Protocol):
    """Node as seen by what makes its entities."""

    @property
    def _owner_(self) -> Owner:
        """The node as the graph knows it."""

    @property
    def _entity_store_(self) -> EntityStore:
        """Store of its entities."""

    def resolve_topic_name(self, topic: str) -> str:
        """Return the fully qualified name of a topic."""

    def resolve_service_name(self, service: str) -> str:
        """Return the fully qualified name of a service."""

    def declare_parameter(self, name: str, value: Any, descriptor: ParameterDescriptor) -> Parameter[Any]:
        """Declare a parameter, by which a policy of a topic's QoS may be changed."""

    def get_parameter(self, name: str) -> Parameter[Any]:
        """Return a parameter."""
