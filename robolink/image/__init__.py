"""Images as numpy arrays, for programs that look at what a camera sees: two functions, one for each way.

    image = to_array(message, "bgr8")  # of sensor_msgs.msg.Image or CompressedImage
    publisher.publish(to_message(image, "bgr8", message.header))

Conversions between encodings are OpenCV's, bit for bit, and need it only for JPEG, PNG, Bayer patterns and YUV
(``pip install opencv-python``). `cv_bridge` has the same under ROS 2's names.
"""

from robolink.image.arrays import to_array, to_message
from robolink.image.encodings import ImageError

__all__ = ["ImageError", "to_array", "to_message"]
