"""The topics of one robot, found by their types and by names as Webots spells them."""

from __future__ import annotations

import re
from collections.abc import Iterable

from robolink.interfaces.sensor_msgs.msg import JointState
from robolink.message import Message, type_name
from robolink.node import Node


def plain(name: str) -> str:
    """Return a name without characters that ROS cannot spell, to compare: `LDS-01` is `lds_01` there.

    >>> plain("LDS-01"), plain("lds_01")
    ('lds01', 'lds01')
    """
    return "".join(filter(str.isalnum, name.lower()))


def words_of(name: str) -> set[str]:
    """Return the words and numbers of a device's name, to compare.

    >>> words_of("left_wheel sensor") == {"left", "wheel", "sensor"}, words_of("encoder1") == {"encoder", "1"}
    (True, True)
    """
    return set(re.findall(r"[^\W\d_]+|\d+", name.lower()))


class RobotTopics:
    """The topics of one robot: `prefix` is its name and a slash where there are several, else ''; or it is absolute."""

    def __init__(self, node: Node, prefix: str) -> None:
        self.node, self.prefix = node, prefix
        self.joint_states = node.resolve_topic_name(f"{prefix}joint_states")
        self._base = self.joint_states.rpartition("/")[0]

    def of_type(self, message: type[Message]) -> list[str]:
        """Return the names of the robot's topics of this type, without their common prefix.

        Topics that only have subscriptions, or publishers of this node alone, are no sensors.
        """
        wanted, base = type_name(message), self._base + "/"
        found = self.node.get_topic_names_and_types()
        names = [name for name, types in found if wanted in types and name.startswith(base)]
        return [name.removeprefix(base) for name in names if self._is_of_others(name)]

    def _is_of_others(self, topic: str) -> bool:
        own = (self.node.get_name(), self.node.get_namespace())
        publishers = self.node.get_publishers_info_by_topic(topic)
        return any((each.node_name, each.node_namespace) != own for each in publishers)

    def elsewhere(self) -> list[str]:
        """Return the joint_states topics of all robots."""
        wanted, found = type_name(JointState), self.node.get_topic_names_and_types()
        names = [name for name, types in found if wanted in types and name.endswith("/joint_states")]
        return [name for name in names if self.node.count_publishers(name)]

    def find(self, message: type[Message], name: str, *, or_only: bool) -> str:
        """Return the topic of a sensor by its name, or if `or_only` the only one of this type; '' if there is none."""
        topics = self.of_type(message)
        found = next((each for each in topics if plain(each) == plain(name)), "")
        return found or (topics[0] if or_only and len(topics) == 1 else "")


def quoted(names: Iterable[str]) -> str:
    """Return names in quotes, or 'none'."""
    return ", ".join(f"'{each}'" for each in names) or "none"
