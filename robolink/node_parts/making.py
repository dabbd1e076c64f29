"""Making of a node's publishers, subscriptions, services and clients, of any class of these, for any kind of node."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, TypeVar, cast

from robolink.publisher import Publisher
from robolink.qos import QoSProfile, as_profile
from robolink.service import Service
from robolink.subscription import Subscription
from robolink.type_support import check_is_valid_msg_type, check_is_valid_srv_type

if TYPE_CHECKING:
    from robolink.callback_groups import CallbackGroup
    from robolink.client import BaseClient
    from robolink.event_handler import PublisherEventCallbacks, SubscriptionEventCallbacks
    from robolink.node_parts.ports import MakingNode
    from robolink.qos_overriding_options import QoSOverridingOptions
    from robolink.subscription_content_filter_options import ContentFilterOptions

PublisherT = TypeVar("PublisherT", bound=Publisher[Any])
SubscriptionT = TypeVar("SubscriptionT", bound=Subscription[Any])
ServiceT = TypeVar("ServiceT", bound=Service)
ClientT = TypeVar("ClientT", bound="BaseClient")


def make_publisher(
    node: MakingNode,
    kind: type[PublisherT],
    msg_type: type[Any],
    topic: str,
    qos_profile: QoSProfile | int,
    group: CallbackGroup,
    events: PublisherEventCallbacks | None = None,
    overriding: QoSOverridingOptions | None = None,
) -> PublisherT:
    """Make a publisher of a class, `kind`, for a node, which owns it; see `Node.create_publisher`."""
    name = node.resolve_topic_name(topic)
    check_is_valid_msg_type(msg_type)
    qos = _overridden(Publisher, node, name, qos_profile, overriding)
    made = kind(node._owner_, msg_type, name, qos, event_callbacks=events, callback_group=group)
    made.topic = topic  # as written, as in rclpy; `topic_name` is the whole one
    made._keeps_ = node
    node._entity_store_.add_publisher(made)
    return made


def make_subscription(
    node: MakingNode,
    kind: type[SubscriptionT],
    msg_type: type[Any],
    topic: str,
    callback: Callable[..., Any],
    qos_profile: QoSProfile | int,
    group: CallbackGroup,
    raw: bool = False,
    content_filter: ContentFilterOptions | None = None,
    events: SubscriptionEventCallbacks | None = None,
    overriding: QoSOverridingOptions | None = None,
) -> SubscriptionT:
    """Make a subscription of a class, `kind`, for a node, which owns it; see `Node.create_subscription`."""
    name = node.resolve_topic_name(topic)
    check_is_valid_msg_type(msg_type)
    qos = _overridden(Subscription, node, name, qos_profile, overriding)
    made = kind(node._owner_, msg_type, name, callback, group, qos, raw, events)
    made.topic = topic
    if content_filter is not None:
        made.warn_of_filter(content_filter.filter_expression)
    node._entity_store_.add_subscription(made)
    return made


def make_service(
    node: MakingNode,
    kind: type[ServiceT],
    srv_type: type[Any],
    srv_name: str,
    callback: Callable[[Any, Any], Any],
    qos_profile: QoSProfile,
    group: CallbackGroup,
) -> ServiceT:
    """Make a service of a class, `kind`, for a node, which owns it; see `Node.create_service`."""
    name = node.resolve_service_name(srv_name)
    check_is_valid_srv_type(srv_type)
    made = kind(node._owner_, srv_type, name, callback, group, qos_profile)
    made.srv_name = srv_name
    return node._entity_store_.add(made, cast("list[ServiceT]", node._entity_store_.services))


def make_client(
    node: MakingNode,
    kind: type[ClientT],
    srv_type: type[Any],
    srv_name: str,
    qos_profile: QoSProfile,
    group: CallbackGroup,
) -> ClientT:
    """Make a client of a class, `kind`, for a node, which owns it; see `Node.create_client`."""
    name = node.resolve_service_name(srv_name)
    check_is_valid_srv_type(srv_type)
    made = kind(node._owner_, srv_type, name, qos_profile, group)
    made.srv_name = srv_name
    made._keeps_ = node
    return node._entity_store_.add(made, cast("list[ClientT]", node._entity_store_.clients))


def _overridden(
    kind: type[Any], node: MakingNode, name: str, qos: QoSProfile | int, options: QoSOverridingOptions | None
) -> QoSProfile:
    """Return the profile with the policies that parameters override, where options allow them."""
    profile = as_profile(qos)
    if options is None:
        return profile
    from robolink.qos_overriding_options import overridden  # late: few nodes ask

    return overridden(kind, node, name, profile, options)
