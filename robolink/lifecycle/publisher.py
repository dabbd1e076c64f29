"""Publisher of a managed node: it sends only while the node is active."""

from __future__ import annotations

from typing import Any

from robolink.lifecycle.managed_entity import SimpleManagedEntity, TransitionCallbackReturn
from robolink.logging import get_logger
from robolink.publisher import MsgT, Publisher


class LifecyclePublisher(SimpleManagedEntity, Publisher[MsgT]):
    """A publisher that drops messages while its node is not active; made by `create_lifecycle_publisher`.

    `args` and `kwargs` are those of `Publisher`.
    """

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        SimpleManagedEntity.__init__(self)
        Publisher.__init__(self, *args, **kwargs)
        self._warned = False

    def on_activate(self, state: Any) -> TransitionCallbackReturn:
        """Send from now on; `state` is the one before."""
        self._warned = False
        return super().on_activate(state)

    def publish(self, msg: MsgT | bytes) -> None:
        """Publish `msg` while active, as `Publisher.publish` does; else drop it, with one warning a time."""
        if self._enabled:
            Publisher.publish(self, msg)
        elif not self._warned:
            self._warned = True
            get_logger(self.logger_name).warning(
                f"dropped a message for {self.topic_name}: its publisher is not active (the next ones go silently)"
            )
