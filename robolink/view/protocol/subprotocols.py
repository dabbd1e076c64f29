"""WebSocket subprotocols of the view, with Foxglove's numbers of operations and words for capabilities."""

from __future__ import annotations

ROBOLINK = "robolink.v1"
"""Subprotocol of the page: Foxglove's, with batches, credits, rates, statistics and recording."""
FOXGLOVE_SDK = "foxglove.sdk.v1"
FOXGLOVE_WEBSOCKET = "foxglove.websocket.v1"
SUBPROTOCOLS = (ROBOLINK, FOXGLOVE_SDK, FOXGLOVE_WEBSOCKET)
"""All of them, the preferred one first."""

INFO, WARNING, ERROR = 0, 1, 2
"""Levels of a status."""

PLAYING, PAUSED, BUFFERING, ENDED = 0, 1, 2, 3
"""States of playback."""

ENCODINGS = ("cdr", "json")
"""Encodings in which clients may publish and call."""
