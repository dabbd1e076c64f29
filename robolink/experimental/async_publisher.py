"""Publishers of an AsyncNode."""

from __future__ import annotations

import contextlib
from typing import Any

from robolink.publisher import Publisher
from robolink.subscription import MsgT


class AsyncPublisher(Publisher[MsgT]):
    """Publisher of an AsyncNode, whose `publish` does not wait; made by `AsyncNode.create_publisher`."""

    def destroy(self) -> None:
        """End the publisher. Safe to call twice."""
        node: Any = self._keeps_
        super().destroy()
        if node is not None:
            with contextlib.suppress(ValueError):  # the node itself destroys it
                node._entity_store_.publishers.remove(self)
