"""The publisher of a managed node: it sends only while the node is active."""

from __future__ import annotations

from typing import Any

from robolink.lifecycle.managed_entity import SimpleManagedEntity, TransitionCallbackReturn
from robolink.logging import get_logger
from robolink.publisher import MsgT, Publisher


class LifecyclePublisher(SimpleManagedEntity, Publisher[MsgT]):
    """A publisher that drops what it is given while its node is not active; made by `create_lifecycle_publisher`."""

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        SimpleManagedEntity.__init__(self)
        Publisher.__init__(self, *args, **kwargs)
        self._warned = False

    def on_activate(self, state: Any) -> TransitionCallbackReturn:
        """Send from now on."""
        self._warned = False
        return super().on_activate(state)

    def publish(self, msg: MsgT | bytes) -> None:
        """Send a message while active, as `Publisher.publish` does; else drop it, with one warning a time."""
        if self._enabled:
            Publisher.publish(self, msg)
        elif not self._warned:
            self._warned = True
            get_logger(self.logger_name).warning(
                f"dropped a message for {self.topic}: its publisher is not active (the next ones go silently)"
            )
