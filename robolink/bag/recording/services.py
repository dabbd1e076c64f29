"""rosbag2's services of a recorder, and the node that serves them while it records."""

from __future__ import annotations

import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

from robolink.bag.recording.recording import News, Recording, RecordingError
from robolink.bag.recording.topics import RecordSettings
from robolink.bag.selection import Selection
from robolink.exceptions import RobolinkError
from robolink.expand_topic_name import expand_topic_name
from robolink.interfaces.rosbag2_interfaces.msg import WriteSplitEvent
from robolink.interfaces.rosbag2_interfaces.srv import (
    IsDiscoveryRunning,
    IsPaused,
    Pause,
    Record,
    Resume,
    Snapshot,
    SplitBagfile,
    StartDiscovery,
    Stop,
    StopDiscovery,
    TogglePaused,
)
from robolink.node import Node
from robolink.validate_full_topic_name import validate_full_topic_name


class RecorderServices:
    """Remote control of a recorder, and the publisher of `events/write_split`.

    The services are `~/record`, `~/stop`, `~/pause`, `~/resume`, `~/toggle_paused`, `~/is_paused`, `~/split_bagfile`,
    `~/start_discovery`, `~/stop_discovery`, `~/is_discovery_running`, and in snapshot mode `~/snapshot`.

    Args:
        node: Node that serves them; an executor has to spin it.
    """

    def __init__(self, node: Node) -> None:
        self._node = node
        self._served: ServedRecording | None = None
        self._splits = node.create_publisher(WriteSplitEvent, "events/write_split", 1)

    def serve(self, recorder: ServedRecording) -> None:
        """Serve a recorder from now on."""
        self._served = recorder
        node = self._node
        node.create_service(Record, "~/record", self._record)
        node.create_service(Stop, "~/stop", self._stop)
        node.create_service(Pause, "~/pause", self._pause)
        node.create_service(Resume, "~/resume", self._resume)
        node.create_service(TogglePaused, "~/toggle_paused", self._toggle)
        node.create_service(IsPaused, "~/is_paused", self._is_paused)
        node.create_service(SplitBagfile, "~/split_bagfile", self._split)
        node.create_service(StartDiscovery, "~/start_discovery", self._start_discovery)
        node.create_service(StopDiscovery, "~/stop_discovery", self._stop_discovery)
        node.create_service(IsDiscoveryRunning, "~/is_discovery_running", self._is_discovery_running)
        if recorder.recording.settings.snapshot_mode:  # as in rosbag2: nobody finds it else
            node.create_service(Snapshot, "~/snapshot", self._snapshot)

    def tell_of_split(self, closed: Path, opened: Path) -> None:
        """Publish that the recording goes on in another file; called on the writer's thread."""
        name = self._node.get_fully_qualified_name()
        self._splits.publish(WriteSplitEvent(closed_file=str(closed), opened_file=str(opened), node_name=name))

    def _record(self, request: Any, response: Any) -> Any:
        return self._answered(response, lambda: self._recorder.record(request.uri))

    def _stop(self, _: Any, response: Any) -> Any:
        self._tried(self._recorder.stop)
        return response

    def _pause(self, _: Any, response: Any) -> Any:
        self._recorder.pause()
        return response

    def _resume(self, _: Any, response: Any) -> Any:
        self._recorder.resume()
        return response

    def _toggle(self, _: Any, response: Any) -> Any:
        self._recorder.toggle_paused()
        return response

    def _is_paused(self, _: Any, response: Any) -> Any:
        response.paused = self._recorder.is_paused
        return response

    def _split(self, _: Any, response: Any) -> Any:
        self._tried(self._recorder.recording.split)
        return response

    def _start_discovery(self, _: Any, response: Any) -> Any:
        return self._answered(response, self._recorder.recording.start_discovery)

    def _stop_discovery(self, _: Any, response: Any) -> Any:
        return self._answered(response, self._recorder.recording.stop_discovery)

    def _is_discovery_running(self, _: Any, response: Any) -> Any:
        response.running = self._recorder.recording.is_discovering
        return response

    def _snapshot(self, _: Any, response: Any) -> Any:
        response.success = bool(self._tried(self._recorder.recording.snapshot))
        return response

    def _answered(self, response: Any, action: Callable[[], object]) -> Any:
        """Call an action; an error goes into the response, and is logged."""
        try:
            action()
        except (RobolinkError, OSError, TimeoutError) as error:
            self._node.get_logger().warning(str(error))
            response.return_code, response.error_string = 1, str(error)
        return response

    def _tried(self, action: Callable[[], Any]) -> Any:
        """Call an action; an error is logged, since these services have no place for it."""
        try:
            return action()
        except (RobolinkError, OSError, TimeoutError) as error:
            self._node.get_logger().error(str(error))
            return None

    @property
    def _recorder(self) -> ServedRecording:
        assert self._served is not None
        return self._served


class ServedRecording:
    """Recorder that others can steer by services of its node: one recording after the other, each into its own bag.

    Args:
        node: Node that subscribes and serves; an executor has to spin it.
        path: Folder of the first bag, which must not be there yet.
        selection: Topics to record; relative names are completed as the node's.
        settings: How to record them.

    Raises:
        SelectionError: (a ValueError) if nothing is selected.
        InvalidTopicNameException: (a ValueError) for a name that is none.
    """

    def __init__(self, node: Node, path: str | Path, selection: Selection, settings: RecordSettings) -> None:
        self._services, self._failed = RecorderServices(node), threading.Event()
        self._node, self._path, self._settings = node, Path(path), settings
        self._selection = _completed(node, selection)
        self._lock = threading.Lock()
        self.recording = self._made(self._path, settings)
        """The recording that runs, or the last one."""

    @property
    def is_over(self) -> bool:
        """True once a bag can no longer be written."""
        return self._failed.is_set()

    @property
    def is_paused(self) -> bool:
        """True while messages are let pass, also for the next recording."""
        return self.recording.is_paused if self.recording.is_running else self._settings.start_paused

    def start(self) -> None:
        """Make the bag and record, then serve: whoever finds the services knows that it listens.

        Raises BagError (a ValueError) or OSError if the bag cannot be made.
        """
        self.recording.start()
        self._services.serve(self)

    def record(self, uri: str = "") -> None:
        """Record again after `stop`, into the folder `uri`, or by default into that of the first bag.

        Raises RecordingError (a RuntimeError) while it records, BagError (a ValueError) or OSError if the bag cannot be
        made.
        """
        with self._lock:
            if self.recording.is_running:
                raise RecordingError("Recorder is already recording.")
            fresh = self._made(Path(uri) if uri else self._path, self._settings)
            fresh.start()
            self.recording = fresh
        self._node.get_logger().info(f"Recording into {fresh.path}")

    def stop(self) -> None:
        """Write all that has come, and close the bag. Raises RecordingError (a RuntimeError) if it has stopped."""
        with self._lock:
            if not self.recording.is_running:
                raise RecordingError("Recorder is already stopped.")
            self._settings = self._settings._replace(start_paused=self.recording.is_paused)
            self.recording.stop()
        self._node.get_logger().info("Recording stopped")

    def pause(self) -> None:
        """Let messages pass, also of the next recording."""
        self._settings = self._settings._replace(start_paused=True)
        if self.recording.is_running:
            self.recording.pause()

    def resume(self) -> None:
        """Record messages again, also those of the next recording."""
        self._settings = self._settings._replace(start_paused=False)
        if self.recording.is_running:
            self.recording.resume()

    def toggle_paused(self) -> None:
        """Pause, or record again."""
        (self.resume if self.is_paused else self.pause)()

    def _made(self, path: Path, settings: RecordSettings) -> Recording:
        logger = self._node.get_logger()
        news = News(logger.info, logger.warning, lambda _: self._failed.set(), self._services.tell_of_split)
        return Recording(self._node, path, self._selection, settings, news)


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
