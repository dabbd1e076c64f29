"""QoS overrides: parameters that change the QoS of a node's publishers and subscriptions."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any, Protocol, TypeAlias

from robolink.duration import Duration
from robolink.exceptions import ParameterAlreadyDeclaredException, RobolinkError, nearest
from robolink.interfaces.rcl_interfaces.msg import ParameterDescriptor, SetParametersResult
from robolink.publisher import Publisher
from robolink.qos import QoSPolicyEnum as _PolicyEnum
from robolink.qos import QoSPolicyKind, QoSProfile
from robolink.subscription import Subscription

if TYPE_CHECKING:
    from robolink.parameter import Parameter

QosCallbackResult: TypeAlias = SetParametersResult
QosCallbackType: TypeAlias = Callable[[QoSProfile], QosCallbackResult]


class QosDeclarer(Protocol):
    """Node as seen by the code that declares its QoS parameters."""

    def declare_parameter(self, name: str, value: Any, descriptor: ParameterDescriptor) -> Parameter[Any]:
        """Declare the parameter `name` with the default `value` and this `descriptor`."""

    def get_parameter(self, name: str) -> Parameter[Any]:
        """Return the parameter `name`."""


class InvalidQosOverridesError(RobolinkError, RuntimeError):
    """A parameter gives a policy a value that it cannot have, or the node's own check refused the whole profile."""


class QoSOverridingOptions:
    """Policies of a publisher or subscription that parameters may change.

    Args:
        policy_kinds: Policies that get a parameter, `qos_overrides./topic.publisher.depth` for example.
        callback: Function of the profile that results; it returns a SetParametersResult, which may refuse it.
        entity_id: Part of the parameters' names, by which two publishers or subscriptions of one topic differ.
    """

    def __init__(
        self,
        policy_kinds: Iterable[QoSPolicyKind],
        *,
        callback: QosCallbackType | None = None,
        entity_id: str | None = None,
    ) -> None:
        self._policy_kinds = policy_kinds
        self._callback = callback
        self._entity_id = entity_id

    @property
    def policy_kinds(self) -> Iterable[QoSPolicyKind]:
        """Policies that get a parameter."""
        return self._policy_kinds

    @property
    def callback(self) -> QosCallbackType | None:
        """Function that checks the profile that results."""
        return self._callback

    @property
    def entity_id(self) -> str | None:
        """Part of the parameters' names, by which it differs from others on its topic."""
        return self._entity_id

    @classmethod
    def with_default_policies(
        cls, *, callback: QosCallbackType | None = None, entity_id: str | None = None
    ) -> QoSOverridingOptions:
        """Return options for history, depth and reliability, with this `callback` and `entity_id`."""
        kinds = (QoSPolicyKind.HISTORY, QoSPolicyKind.DEPTH, QoSPolicyKind.RELIABILITY)
        return cls(kinds, callback=callback, entity_id=entity_id)


def overridden(
    entity_type: type[Publisher[Any] | Subscription[Any]],
    node: QosDeclarer,
    topic_name: str,
    qos: QoSProfile,
    options: QoSOverridingOptions,
) -> QoSProfile:
    """Return a copy of a profile, with the policies that parameters override.

    Args:
        entity_type: Publisher or Subscription.
        node: Node that declares the parameters.
        topic_name: Fully qualified name of the topic.
        qos: Profile whose policies are the defaults.
        options: Policies that parameters may change.

    Raises:
        InvalidQosOverridesError: (a RuntimeError) if a parameter or the check refuses the profile.
        ValueError: if `qos` itself has a policy UNKNOWN, or a number that the policy cannot have.
        InvalidParameterTypeException: (a TypeError) if a parameter has another type.
    """
    changed = QoSProfile(**qos.to_dict())
    _declare_qos_parameters(entity_type, node, topic_name, changed, options)
    return changed


def _declare_qos_parameters(
    entity_type: type[Publisher[Any] | Subscription[Any]],
    node: QosDeclarer,
    topic_name: str,
    qos: QoSProfile,
    options: QoSOverridingOptions,
) -> None:
    """Declare a read-only parameter for each policy, ``qos_overrides./topic.publisher.depth``, and change `qos` to it.

    Raises InvalidQosOverridesError (a RuntimeError), ValueError where `qos` itself has a policy UNKNOWN or a number
    that the policy cannot have, and InvalidParameterTypeException. The name is rclpy's, whose tests call it.
    """
    if not issubclass(entity_type, (Publisher, Subscription)):
        raise TypeError(f"entity_type must be a subclass of Publisher or Subscription, got {entity_type!r}")
    entity = "publisher" if issubclass(entity_type, Publisher) else "subscription"
    id_ = "" if options.entity_id is None else f"_{options.entity_id}"
    for kind in options.policy_kinds:
        if entity == "subscription" and kind is QoSPolicyKind.LIFESPAN:  # only publishers have one
            continue
        policy = kind.name.lower()
        name = f"qos_overrides.{topic_name}.{entity}{id_}.{policy}"
        text = f"{policy} of the {entity} of {topic_name}{f' called {options.entity_id}' if id_ else ''}"
        try:
            descriptor = ParameterDescriptor(description=text, read_only=True)
            parameter = node.declare_parameter(name, _get_qos_policy_parameter(qos, kind), descriptor)
        except ParameterAlreadyDeclaredException:
            parameter = node.get_parameter(name)
        _set_policy(qos, policy, parameter.value, name)
    result = None if options.callback is None else options.callback(qos)
    if result is not None and not result.successful:
        raise InvalidQosOverridesError(
            f"the QoS of the {entity} of {topic_name}, with its parameters, is refused: {result.reason}"
        )


def _get_qos_policy_parameter(qos: QoSProfile, policy: QoSPolicyKind) -> str | int | bool:
    """Return the default of a policy's parameter: names in lower case, spans of time in nanoseconds."""
    value = getattr(qos, policy.name.lower())
    if isinstance(value, _PolicyEnum):
        if value.name == "UNKNOWN":
            raise ValueError(f"the QoS profile is invalid: its {policy.name.lower()} is UNKNOWN")
        return value.short_key
    return value.nanoseconds if isinstance(value, Duration) else value


def _set_policy(qos: QoSProfile, policy: str, value: Any, parameter: str) -> None:
    before = getattr(qos, policy)
    if isinstance(before, Duration):
        value = Duration(nanoseconds=value)
    elif isinstance(before, _PolicyEnum):
        known = type(before).short_keys()
        if value.lower() not in known:
            near = nearest(value, known) or f": it can be {', '.join(known)}"
            raise InvalidQosOverridesError(f"parameter '{parameter}': Unexpected QoS override '{value}'{near}")
        value = type(before)[value.upper()]
    setattr(qos, policy, value)
