"""Reaction to a text that tells that a process is ready (`launch_testing.event_handlers`)."""

from __future__ import annotations

from robolink.launch.ros.launch.bases import Action, LaunchDescriptionEntity, SomeEntitiesType, entities_in
from robolink.launch.ros.launch.event_handlers import OnProcessIO
from robolink.launch.ros.launch.process_events import ProcessIO

__all__ = ["StdoutReadyListener"]


class StdoutReadyListener(OnProcessIO):
    """Reaction to a text that a process writes once it is ready.

    Args:
        target_action: The action that starts the process; None is any.
        ready_txt: The text, which is within a line.
        actions: What follows, such as a ReadyToTest.
    """

    def __init__(self, *, target_action: Action | None = None, ready_txt: str, actions: SomeEntitiesType) -> None:
        self._text, self._actions = ready_txt, actions
        super().__init__(target_action=target_action, on_stdout=self._follow)

    def describe(self) -> tuple[str, list[LaunchDescriptionEntity]]:
        """Return a description for people, and what follows."""
        return type(self).__name__, entities_in(self._actions)

    def _follow(self, event: ProcessIO) -> SomeEntitiesType | None:
        return self._actions if self._text in event.text.decode(errors="replace") else None
