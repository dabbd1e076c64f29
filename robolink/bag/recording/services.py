"""rosbag2's services of a recorder, and the node that serves them while it records."""

from __future__ import annotations

import threading
from pathlib import Path
from typing import Any

from robolink.bag.recording.recording import News, Recording
from robolink.bag.recording.topics import RecordSettings
from robolink.bag.selection import Selection
from robolink.exceptions import RobolinkError
from robolink.expand_topic_name import expand_topic_name
from robolink.interfaces.rosbag2_interfaces.msg import WriteSplitEvent
from robolink.interfaces.rosbag2_interfaces.srv import (
    IsPaused,
    Pause,
    Resume,
    Snapshot,
    SplitBagfile,
    Stop,
    TogglePaused,
)
from robolink.node import Node
from robolink.validate_full_topic_name import validate_full_topic_name


class RecorderServices:
    """Remote control of a recording, and the publisher of `events/write_split`.

    The services are `~/pause`, `~/resume`, `~/toggle_paused`, `~/is_paused`, `~/split_bagfile`, `~/stop`, and in
    snapshot mode `~/snapshot`.

    Args:
        node: Node that serves them; an executor has to spin it.
    """

    def __init__(self, node: Node) -> None:
        self.stopped = threading.Event()
        """Set when somebody has called `~/stop`."""
        self._node = node
        self._recording: Recording | None = None
        self._splits = node.create_publisher(WriteSplitEvent, "events/write_split", 1)

    def serve(self, recording: Recording) -> None:
        """Serve a recording from now on."""
        self._recording = recording
        node = self._node
        node.create_service(Pause, "~/pause", self._pause)
        node.create_service(Resume, "~/resume", self._resume)
        node.create_service(TogglePaused, "~/toggle_paused", self._toggle)
        node.create_service(IsPaused, "~/is_paused", self._is_paused)
        node.create_service(SplitBagfile, "~/split_bagfile", self._split)
        node.create_service(Stop, "~/stop", self._stop)
        if recording.settings.snapshot_mode:  # as in rosbag2: nobody finds it else
            node.create_service(Snapshot, "~/snapshot", self._snapshot)

    def tell_of_split(self, closed: Path, opened: Path) -> None:
        """Publish that the recording goes on in another file; called on the writer's thread."""
        name = self._node.get_fully_qualified_name()
        self._splits.publish(WriteSplitEvent(closed_file=str(closed), opened_file=str(opened), node_name=name))

    def _pause(self, _: Any, response: Any) -> Any:
        self._served.pause()
        return response

    def _resume(self, _: Any, response: Any) -> Any:
        self._served.resume()
        return response

    def _toggle(self, _: Any, response: Any) -> Any:
        self._served.toggle_paused()
        return response

    def _is_paused(self, _: Any, response: Any) -> Any:
        response.paused = self._served.is_paused
        return response

    def _split(self, _: Any, response: Any) -> Any:
        self._tried(self._served.split)
        return response

    def _snapshot(self, _: Any, response: Any) -> Any:
        response.success = bool(self._tried(self._served.snapshot))
        return response

    def _stop(self, _: Any, response: Any) -> Any:
        self.stopped.set()
        self._node.context.graph.wake()
        return response

    def _tried(self, action: Any) -> Any:
        """Call an action; an error is logged, since these services have no place for it."""
        try:
            return action()
        except (RobolinkError, OSError, TimeoutError) as error:
            self._node.get_logger().error(str(error))
            return None

    @property
    def _served(self) -> Recording:
        assert self._recording is not None
        return self._recording


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
