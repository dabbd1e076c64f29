"""Subscriptions of an AsyncNode."""

from __future__ import annotations

from robolink.experimental.loop_entity import cancel_callbacks, leave
from robolink.subscription import MsgT, Subscription


class AsyncSubscription(Subscription[MsgT]):
    """Subscription whose callback runs on asyncio's event loop; made by `AsyncNode.create_subscription`."""

    def destroy(self) -> None:
        """End the subscription, and cancel its callbacks under way. Safe to call twice."""
        if self._destroyed:
            return
        cancel_callbacks(self)
        super().destroy()
        leave(self, "subscriptions")
