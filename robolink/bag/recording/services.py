"""Services of a recorder's node, with rosbag2's names and types, and its topic of files that are split."""

from __future__ import annotations

import threading
from pathlib import Path
from typing import TYPE_CHECKING, Any

from robolink.exceptions import RobolinkError
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

if TYPE_CHECKING:
    from robolink.bag.recording.recording import Recording
    from robolink.node import Node


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
