"""Transforms between frames, over time: the API of ROS 2's tf2_ros.

A node that looks up transforms has a Buffer and a TransformListener that fills it::

    self.buffer = Buffer()
    self.listener = TransformListener(self.buffer, self)
    ...
    self.buffer.lookup_transform("map", "base_link", Time())

Everything is imported when it is first used: commands that only look at transforms need no action clients.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from robolink.text.suggestions import lazily

if TYPE_CHECKING:
    from robolink.interfaces.geometry_msgs.msg import TransformStamped
    from robolink.tf2.buffer import Buffer
    from robolink.tf2.buffer_client import BufferClient
    from robolink.tf2.buffer_interface import (
        BufferInterface,
        ConvertRegistration,
        NotImplementedException,
        Stamped,
        TransformRegistration,
        TypeException,
        convert,
    )
    from robolink.tf2.buffer_server import BufferServer
    from robolink.tf2.core import BufferCore
    from robolink.tf2.exceptions import (
        ConnectivityException,
        ExtrapolationException,
        InvalidArgumentException,
        LookupException,
        TimeoutException,
        TransformException,
    )
    from robolink.tf2.static_transform_broadcaster import StaticTransformBroadcaster
    from robolink.tf2.static_transform_listener import StaticTransformListener
    from robolink.tf2.transform_broadcaster import TransformBroadcaster
    from robolink.tf2.transform_listener import TransformListener

__all__ = [
    "Buffer",
    "BufferClient",
    "BufferCore",
    "BufferInterface",
    "BufferServer",
    "ConnectivityException",
    "ConvertRegistration",
    "ExtrapolationException",
    "InvalidArgumentException",
    "LookupException",
    "NotImplementedException",
    "Stamped",
    "StaticTransformBroadcaster",
    "StaticTransformListener",
    "TimeoutException",
    "TransformBroadcaster",
    "TransformException",
    "TransformListener",
    "TransformRegistration",
    "TransformStamped",
    "TypeException",
    "convert",
]

_HOMES = {
    "Buffer": "buffer",
    "BufferClient": "buffer_client",
    "BufferCore": "core",
    "BufferInterface": "buffer_interface",
    "BufferServer": "buffer_server",
    "ConnectivityException": "exceptions",
    "ConvertRegistration": "buffer_interface",
    "ExtrapolationException": "exceptions",
    "InvalidArgumentException": "exceptions",
    "LookupException": "exceptions",
    "NotImplementedException": "buffer_interface",
    "Stamped": "buffer_interface",
    "StaticTransformBroadcaster": "static_transform_broadcaster",
    "StaticTransformListener": "static_transform_listener",
    "TimeoutException": "exceptions",
    "TransformBroadcaster": "transform_broadcaster",
    "TransformException": "exceptions",
    "TransformListener": "transform_listener",
    "TransformRegistration": "buffer_interface",
    "TransformStamped": "buffer_interface",
    "TypeException": "buffer_interface",
    "convert": "buffer_interface",
}
_ROOMS = frozenset(_HOMES.values()) | {"geometry", "point_cloud"}

__getattr__, __dir__ = lazily(__name__, _HOMES, _ROOMS)
