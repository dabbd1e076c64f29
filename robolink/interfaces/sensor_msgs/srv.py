"""The service of sensor_msgs: storing a camera's calibration."""

from robolink.interfaces.sensor_msgs.msg import CameraInfo
from robolink.message import Message, Service, string


class SetCameraInfo(Service):
    """Store a calibration in a camera."""

    class Request(Message):
        """The calibration; its width and height are those of the images that the camera sends now."""

        camera_info: CameraInfo

    class Response(Message):
        """True if it was stored, and a sentence for people."""

        success: bool
        status_message: string
