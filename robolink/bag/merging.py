"""Several bags as one: their topics by name, and their messages in the order of their log times."""

from __future__ import annotations

import heapq
from collections.abc import Callable, Collection, Iterable, Iterator

from robolink.bag.reader import Bag
from robolink.bag.topic import BagError, BagMessage, BagTopic


def merged_topics(bags: Iterable[Bag], takes: Callable[[str, str], bool], advice: str) -> dict[str, BagTopic]:
    """Return the topics of bags by name, each with all QoS profiles that were offered.

    Args:
        bags: The bags.
        takes: Function of a topic's name and type that returns whether it counts.
        advice: End of the error's text: what can be done about a topic of two types.

    Raises:
        BagError: if a name has two types: a message tells only its topic's name.
    """
    found: dict[str, BagTopic] = {}
    for bag in bags:
        for topic in bag.topics:
            if not takes(topic.name, topic.type_name):
                continue
            known = found.setdefault(topic.name, topic)
            if difference := topic.difference(known):
                raise BagError(f"{bag.path}: {difference}: {advice}")
            fresh = tuple(each for each in topic.offered_qos if each not in known.offered_qos)
            found[topic.name] = known._replace(
                offered_qos=known.offered_qos + fresh,
                message_definition=known.message_definition or topic.message_definition,
                type_hash=known.type_hash or topic.type_hash,
            )
    return found


def merged_messages(
    bags: Iterable[Bag],
    names: Collection[str],
    start: int | None = None,
    end: int | None = None,
    *,
    reverse: bool = False,
) -> Iterator[BagMessage]:
    """Yield the messages of bags in the order of their log times.

    Args:
        bags: The bags.
        names: Names of the topics.
        start: Earliest log time, in nanoseconds since 1970.
        end: Log time before which messages must be.
        reverse: True for the latest first.
    """
    streams = [each.messages(names, start, end, reverse=reverse) for each in bags]
    if len(streams) == 1:
        return streams[0]
    return heapq.merge(*streams, key=lambda message: message.log_time, reverse=reverse)
