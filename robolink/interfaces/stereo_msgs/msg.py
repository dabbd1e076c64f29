"""The message of stereo_msgs: how far the two images of a stereo camera are apart, point by point."""

from robolink.interfaces.sensor_msgs.msg import Image, RegionOfInterest
from robolink.interfaces.std_msgs.msg import Header
from robolink.message import Message, float32


class DisparityImage(Message):
    """For each pixel, how many pixels further left the right camera sees it.

    `image` holds 32-bit floats. A disparity d stands for a depth of ``f * t / d``, where `f` is the focal length in
    pixels and `t` the distance of the two cameras in metres. Disparities were searched from `min_disparity` to
    `max_disparity` pixels, in steps of `delta_d`; what is below the smallest is no measurement, nor is what lies
    outside `valid_window`.
    """

    header: Header
    image: Image
    f: float32
    t: float32
    valid_window: RegionOfInterest
    min_disparity: float32
    max_disparity: float32
    delta_d: float32
