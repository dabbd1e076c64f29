"""Server of the view: HTTP and WebSocket on one port, in a thread of its own."""

from robolink.view.server.view import Settings, View, ViewError

__all__ = ["Settings", "View", "ViewError"]
