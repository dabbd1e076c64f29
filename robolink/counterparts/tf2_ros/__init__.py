"""Counterpart of tf2_ros' buffer_server: it looks up transforms on request."""

from __future__ import annotations

from typing import Any

from robolink.counterparts.program import spin_program
from robolink.duration import Duration
from robolink.node import Node
from robolink.parameters.descriptors import described
from robolink.tf2 import Buffer, BufferServer, TransformListener


class TfBuffer(Node):
    """A node with a buffer of transforms that serves its look-ups. `options` are those of `Node`."""

    def __init__(self, **options: Any) -> None:
        super().__init__("tf_buffer", **options)
        size = self.declare_parameter("buffer_size", 120.0, described("seconds that are kept", 0.1, 1e6)).value
        words = "serve all frames as YAML at tf2_frames"
        serves_frames = self.declare_parameter("publish_frame_service", False, described(words)).value
        self.buffer = Buffer(Duration(seconds=size), self if serves_frames else None)
        self.listener = TransformListener(self.buffer, self)
        self.server = BufferServer(self.buffer, self, "tf2_buffer_server")


def main(args: list[str] | None = None) -> None:
    """Serve transforms until Ctrl-C."""
    spin_program(lambda words: TfBuffer(), args)
