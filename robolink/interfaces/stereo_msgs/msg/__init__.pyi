# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message
import robolink.interfaces.sensor_msgs.msg
import robolink.interfaces.std_msgs.msg

__all__ = ["DisparityImage"]

class DisparityImage(robolink.message.Message):
    """For each pixel, how many pixels further left the right camera sees it.

    `image` holds 32-bit floats. A disparity d stands for a depth of ``f * t / d``, where `f` is the focal length in
    pixels and `t` the distance of the two cameras in metres. Disparities were searched from `min_disparity` to
    `max_disparity` pixels, in steps of `delta_d`; what is below the smallest is not a measurement, nor is what lies
    outside `valid_window`.
    """
    header: robolink.interfaces.std_msgs.msg.Header
    image: robolink.interfaces.sensor_msgs.msg.Image
    f: builtins.float
    t: builtins.float
    valid_window: robolink.interfaces.sensor_msgs.msg.RegionOfInterest
    min_disparity: builtins.float
    max_disparity: builtins.float
    delta_d: builtins.float
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., image: robolink.interfaces.sensor_msgs.msg.Image = ..., f: builtins.float = ..., t: builtins.float = ..., valid_window: robolink.interfaces.sensor_msgs.msg.RegionOfInterest = ..., min_disparity: builtins.float = ..., max_disparity: builtins.float = ..., delta_d: builtins.float = ...) -> None: ...
