# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message
import robolink.interfaces.sensor_msgs.msg

__all__ = ["SetCameraInfo"]

class SetCameraInfo(robolink.message.Service):
    """Store a calibration in a camera.

    The calibration; its width and height are those of the images that the camera sends now.
    """
    class Request(robolink.message.Message):
        camera_info: robolink.interfaces.sensor_msgs.msg.CameraInfo
        def __init__(self, *, camera_info: robolink.interfaces.sensor_msgs.msg.CameraInfo = ...) -> None: ...
    class Response(robolink.message.Message):
        """True if it was stored, and a sentence for people."""
        success: builtins.bool
        status_message: builtins.str
        def __init__(self, *, success: builtins.bool = ..., status_message: builtins.str = ...) -> None: ...
