"""The service of sensor_msgs: storing a camera's calibration."""

from robolink.interfaces.sensor_msgs.msg import CameraInfo
from robolink.message import Message, Service, string


class SetCameraInfo(Service):
    """Have a camera keep a calibration as its own."""

    class Request(Message):
        """The calibration; its width and height are those of the images that the camera sends now."""

        camera_info: CameraInfo

    class Response(Message):
        """Whether it was stored, and a sentence for people."""

        success: bool
        status_message: string
