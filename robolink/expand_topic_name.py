"""Expansion of the name that a user wrote to the fully qualified name of a topic or service."""

from __future__ import annotations

import re

from robolink.exceptions import InvalidTopicNameException, nearest
from robolink.text.names import join
from robolink.validate_namespace import validate_namespace
from robolink.validate_node_name import validate_node_name
from robolink.validate_topic_name import validate_topic_name


def expand_topic_name(topic_name: str, node_name: str, node_namespace: str) -> str:
    """Return the fully qualified name of a topic or service, without remapping.

    >>> expand_topic_name("~/scan", "lidar", "/robot")
    '/robot/lidar/scan'

    The result may still be no full topic name: see `validate_full_topic_name`.

    Args:
        topic_name: Absolute (`/a`), relative (`a`) or private (`~/a`) name; `{node}`, `{ns}` and `{namespace}` are
            replaced.
        node_name: Name of the node, without namespace.
        node_namespace: Namespace of the node, '/' for the root.

    Raises:
        InvalidTopicNameException: (a ValueError) if the topic's name is against ROS 2's rules, or has an unknown
            substitution; InvalidNodeNameException and InvalidNamespaceException for those of the node.
    """
    validate_topic_name(topic_name)
    validate_node_name(node_name)
    validate_namespace(node_namespace)
    values = {"node": node_name, "ns": node_namespace, "namespace": node_namespace}
    name = topic_name
    if name.startswith("~"):
        name = join(node_namespace, node_name) + name[1:]
    for match in re.finditer(r"\{([^}]*)\}", topic_name):
        if match[1] not in values:
            raise InvalidTopicNameException(
                topic_name, f"unknown substitution '{match[0]}'{nearest(match[1], values)}", match.start()
            )
        name = name.replace(match[0], values[match[1]])
    return name if name.startswith("/") else join(node_namespace, name)
