"""Recording with rosbag2's services in its node, and its news in that node's log: what `bag record` runs."""

from __future__ import annotations

import threading
from pathlib import Path

from robolink.bag.recording.recording import News, Recording
from robolink.bag.recording.services import RecorderServices
from robolink.bag.recording.settings import RecordSettings
from robolink.bag.selection import Selection
from robolink.expand_topic_name import expand_topic_name
from robolink.node import Node
from robolink.validate_full_topic_name import validate_full_topic_name


class ServedRecording:
    """Recording that others can steer by services of its node.

    Args:
        node: Node that subscribes and serves; an executor has to spin it.
        path: Folder of the bag, which must not be there yet.
        selection: Topics to record; relative names are completed as the node's.
        settings: How to record them.

    Raises:
        SelectionError: (a ValueError) if nothing is selected.
        InvalidTopicNameException: (a ValueError) for a name that is none.
    """

    def __init__(self, node: Node, path: str | Path, selection: Selection, settings: RecordSettings) -> None:
        self._services, self._failed = RecorderServices(node), threading.Event()
        logger = node.get_logger()
        news = News(logger.info, logger.warning, lambda _: self._failed.set(), self._services.tell_of_split)
        self.recording = Recording(node, path, _completed(node, selection), settings, news)

    @property
    def is_over(self) -> bool:
        """True once the bag can no longer be written, or somebody has called `~/stop`."""
        return self._failed.is_set() or self._services.stopped.is_set()

    def start(self) -> None:
        """Make the bag and record, then serve: whoever finds the services knows that it listens.

        Raises BagError (a ValueError) or OSError if the bag cannot be made.
        """
        self.recording.start()
        self._services.serve(self.recording)


def _completed(node: Node, selection: Selection) -> Selection:
    """Return a selection with full names."""

    def full(names: tuple[str, ...]) -> tuple[str, ...]:
        return tuple(_full_name(node, each) for each in names)

    return selection._replace(
        topics=full(selection.topics),
        services=full(selection.services),
        actions=full(selection.actions),
        exclude_topics=full(selection.exclude_topics),
        exclude_services=full(selection.exclude_services),
        exclude_actions=full(selection.exclude_actions),
    )


def _full_name(node: Node, name: str) -> str:
    found = expand_topic_name(name, node.get_name(), node.get_namespace())
    validate_full_topic_name(found)
    return found
