"""Page for the browser that shows a running system or a bag, and its server, which speaks Foxglove's protocol too."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from robolink.node import Node
    from robolink.view.server import View
    from robolink.view.server.learning import Exercises


def page_of(node: Node, port: int | None = None, exercises: Exercises | None = None) -> View:
    """Return the server of a page that shows the system which a node sees (`robolink.extensions.optional.page`).

    Args:
        node: The node.
        port: Port; None takes the default one, or the next that is free.
        exercises: Exercises for the panel `learn`; None for none.
    """
    from robolink.view.server import Settings, View  # late: its libraries are needed by whoever serves a page
    from robolink.view.sources.live import LiveSource

    return View(LiveSource(node), Settings(port=port), exercises)
