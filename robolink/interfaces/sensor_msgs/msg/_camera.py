"""Cameras: images, and the geometry behind them.

The frame of an image is the camera's optical frame: x to the right, y down, z ahead; its origin is the
optical centre. ``header.stamp`` is the time of exposure.
"""

from typing import Annotated

from robolink.interfaces.std_msgs.msg import Header
from robolink.message import Message, Sequence, Size, float64, string, uint8, uint32


class Image(Message):
    """A picture as raw pixels, row by row from the top left.

    `height` and `width` count pixels, `step` is the length of a row in bytes, so `data` holds ``step *
    height``. `encoding` names channels, order and size of a pixel: ``mono8``, ``rgb8``, ``bgr8``, ``16UC1``,
    ``32FC1`` ...
    """

    header: Header
    height: uint32
    width: uint32
    encoding: string
    is_bigendian: uint8
    step: uint32
    data: Sequence[uint8]


class CompressedImage(Message):
    """A picture as the bytes of a JPEG, PNG or similar file.

    `format` is the pixels' encoding and the codec (``rgb8; jpeg compressed bgr8``), or just ``jpeg`` or
    ``png``.
    """

    header: Header
    format: string
    data: Sequence[uint8]


class RegionOfInterest(Message):
    """A rectangle of pixels in an image of full resolution; all zeros stand for the whole image.

    `do_rectify` says that the rectangle was cut out, and that a rectified one is to be computed from it.
    """

    x_offset: uint32
    y_offset: uint32
    height: uint32
    width: uint32
    do_rectify: bool


class CameraInfo(Message):
    """A camera's calibration, sent along with each of its images. Matrices are row by row, in pixels.

    `k` (3 x 3) projects points of the optical frame to the raw image, `d` are the coefficients of the
    `distortion_model` (``plumb_bob``: k1, k2, t1, t2, k3), `r` (3 x 3) turns the camera so that a stereo
    pair's rows align, and `p` (3 x 4) projects to the rectified image; its last column holds the stereo
    baseline times the focal length. `width` and `height` are those of the calibration. ``k[0] == 0`` means:
    not calibrated. A binning of 0 is the same as 1.
    """

    header: Header
    height: uint32
    width: uint32
    distortion_model: string
    d: Sequence[float64]
    k: Annotated[Sequence[float64], Size(9)]
    r: Annotated[Sequence[float64], Size(9)]
    p: Annotated[Sequence[float64], Size(12)]
    binning_x: uint32
    binning_y: uint32
    roi: RegionOfInterest
