"""Selection of topics of a bag: by names, types and regular expressions, with ros2's rules."""

from __future__ import annotations

import functools
import re
from typing import NamedTuple

from robolink.exceptions import RobolinkError
from robolink.topic_or_service_is_hidden import topic_or_service_is_hidden

SERVICE_EVENT = "/_service_event"
"""End of the name of the topic on which a service that is introspected publishes its events."""

ACTION = "/_action/"
"""Part of the names of an action's topics and services, between the action's name and theirs."""


class SelectionError(RobolinkError, ValueError, RuntimeError):
    """Nothing is selected, or a regular expression cannot be read. rosbag2_py has RuntimeErrors."""


class Selection(NamedTuple):
    """Topics that are recorded, or taken from a bag; names are full ones, with their leading slash.

    What is excluded is so whatever else selects it. Names that are listed count though they are hidden.
    """

    all_topics: bool = False
    all_services: bool = False
    """True to record the events of every service whose introspection is on."""
    all_actions: bool = False
    """True to record the topics of every action, and its services' events."""
    topics: tuple[str, ...] = ()
    topic_types: tuple[str, ...] = ()
    """Types as in `std_msgs/msg/String`."""
    services: tuple[str, ...] = ()
    actions: tuple[str, ...] = ()
    regex: str = ""
    """Regular expression, which is searched for in the names of topics, services and actions."""
    exclude_regex: str = ""
    exclude_topics: tuple[str, ...] = ()
    exclude_topic_types: tuple[str, ...] = ()
    exclude_services: tuple[str, ...] = ()
    exclude_actions: tuple[str, ...] = ()
    include_hidden: bool = False
    """True to record topics whose names have a part that begins with an underscore."""

    @property
    def is_empty(self) -> bool:
        """True if it selects nothing, whatever there is."""
        listed = (self.topics, self.topic_types, self.services, self.actions)
        return not (self.all_topics or self.all_services or self.all_actions or self.regex or any(listed))

    def checked(self) -> Selection:
        """Return it. Raises SelectionError if it selects nothing, or for a regular expression that is none."""
        if self.is_empty:
            raise SelectionError(
                "nothing is selected: name topics, their types, services or actions, or ask for all of them"
            )
        for name, text in (("regex", self.regex), ("exclude_regex", self.exclude_regex)):
            try:
                _compiled(text)
            except re.error as error:
                raise SelectionError(f"{name}: '{text[:100]}' is not a regular expression: {error}") from None
        return self

    def takes(self, topic: str, type_name: str) -> bool:
        """Return whether a topic of this type is to be recorded."""
        action = action_of(topic)
        if action:
            return self._takes_named(action, self.all_actions, self.actions, self.exclude_actions)
        service = service_of(topic)
        if service:
            return self._takes_named(service, self.all_services, self.services, self.exclude_services)
        if type_name in self.exclude_topic_types:
            return False
        listed = topic in self.topics
        if not listed and not self.include_hidden and topic_or_service_is_hidden(topic):
            return False
        return self._takes_named(
            topic, self.all_topics, self.topics, self.exclude_topics, type_name in self.topic_types
        )

    def _takes_named(
        self, name: str, everything: bool, names: tuple[str, ...], excluded: tuple[str, ...], typed: bool = False
    ) -> bool:
        selected = everything or typed or name in names or bool(self.regex and _compiled(self.regex).search(name))
        return (
            selected
            and name not in excluded
            and not (self.exclude_regex and _compiled(self.exclude_regex).search(name))
        )


EVERYTHING = Selection(all_topics=True, all_services=True, all_actions=True, include_hidden=True)
"""Selection of all that a bag has."""


@functools.lru_cache(maxsize=16)
def _compiled(text: str) -> re.Pattern[str]:
    return re.compile(text)


def service_of(topic: str) -> str:
    """Return the service whose events a topic has; '' if it is another topic."""
    return topic.removesuffix(SERVICE_EVENT) if topic.endswith(SERVICE_EVENT) else ""


def action_of(topic: str) -> str:
    """Return the action that a topic is a part of; '' if it is another topic."""
    return topic.partition(ACTION)[0] if ACTION in topic else ""
