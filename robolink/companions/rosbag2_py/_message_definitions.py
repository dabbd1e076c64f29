"""Definitions of the types that are installed here."""

from __future__ import annotations

from robolink.bag.definition import message_definition
from robolink.bag.topic import BagTopic
from robolink.companions.rosbag2_py._storage import MessageDefinition
from robolink.companions.rosidl_runtime.utilities import get_message
from robolink.exceptions import RobolinkError
from robolink.message import type_hash


class LocalMessageDefinitionSource:
    """Source of the definitions of types that are installed here or are in the workspace."""

    def get_full_text(self, root_topic_type: str) -> MessageDefinition:
        """Return the definition of a type with all that it uses: empty, encoding unknown, for an unknown type."""
        found = described(BagTopic("", root_topic_type))
        encoding = "ros2msg" if found.message_definition else "unknown"
        return MessageDefinition(root_topic_type, encoding, found.message_definition, found.type_hash)


def described(topic: BagTopic) -> BagTopic:
    """Return a topic with the definition and the hash of its type, if it is known here."""
    try:
        cls = get_message(topic.type_name)
        text, hash_ = message_definition(cls), topic.type_hash or type_hash(cls)
    except (RobolinkError, ImportError, AttributeError, ValueError):  # what get_message raises for an unknown type
        return topic
    return topic._replace(message_definition=text, type_hash=hash_)
