"""Services of an AsyncNode."""

from __future__ import annotations

from robolink.experimental.loop_entity import cancel_callbacks, leave
from robolink.service import Service


class AsyncService(Service):
    """Service whose callback runs on asyncio's event loop; made by `AsyncNode.create_service`."""

    def destroy(self) -> None:
        """End the service, and cancel its callbacks under way, whose callers get no answer. Safe to call twice."""
        if self._destroyed:
            return
        cancel_callbacks(self)
        super().destroy()
        leave(self, "services")
