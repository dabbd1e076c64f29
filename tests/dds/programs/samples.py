"""Messages that both ends of a conversation make alike from a number, so that each can compare all fields."""

import array
import importlib
import math
import random

INFINITY = math.inf


def made(kind, which, size=0):
    """Return the message of this number; of `size` bytes, if it is an image or a cloud."""
    message = kind()
    fill = globals().get(f"fill_{kind.__name__}")
    fill(message, which, size)
    return message


def number(message):
    """Return the number that a message was made from."""
    name = type(message).__name__
    if name == "String":
        return int(message.data.split()[1])
    if name == "Twist":
        return int(message.linear.x)
    if name == "BasicTypes":
        return message.int32_value
    if name == "UInt8MultiArray":
        return message.layout.data_offset
    return int(message.header.frame_id)


def right(message, which):
    """Whether all fields are those of the message of this number."""
    size = (
        len(message.data)
        if type(message).__name__ in ("Image", "PointCloud2", "OccupancyGrid", "UInt8MultiArray")
        else 0
    )
    return bool(message == made(type(message), which, size))


def head(message, which):
    message.header.frame_id = str(which)
    message.header.stamp.sec = 1_700_000_000 + which
    message.header.stamp.nanosec = 999_999_999 - which


def noise(which, size):
    """Return bytes that are others for each number, in a short time."""
    return (random.Random(which).randbytes(4099) * (size // 4099 + 1))[:size]


def fill_String(message, which, size):
    message.data = f"hello {which} \N{GREEK SMALL LETTER OMEGA}" + "x" * size


def fill_Twist(message, which, size):
    message.linear.x = float(which)
    message.angular.z = -1 / (which + 1)


def fill_LaserScan(message, which, size):
    head(message, which)
    chance = random.Random(which)
    message.angle_min, message.angle_max, message.angle_increment = -3.0, 3.0, 0.0078125
    message.range_min, message.range_max, message.scan_time = 0.125, 12.0, 0.0625
    message.ranges = array.array("f", [INFINITY] * 7 + [chance.uniform(0.2, 12.0) for _ in range(713)])
    message.intensities = array.array("f", range(720))


def fill_PointCloud2(message, which, size):
    head(message, which)
    field = importlib.import_module("sensor_msgs.msg").PointField
    message.fields = [field(name=name, offset=4 * at, datatype=7, count=1) for at, name in enumerate("xyz")]
    message.point_step, message.height, message.width = 16, 1, size // 16
    message.row_step = size
    message.data = array.array("B", noise(which, size))
    message.is_dense = True


def fill_Image(message, which, size):
    head(message, which)
    message.height, message.width, message.step = 1080, 1920, 5760
    message.encoding = "bgr8"
    message.data = array.array("B", noise(which, size))


def fill_OccupancyGrid(message, which, size):
    head(message, which)
    message.info.resolution = 0.05000000074505806
    message.info.width, message.info.height = 1000, size // 1000
    message.info.origin.position.x = -25.0
    message.data = array.array("b", noise(which, size))


def fill_BasicTypes(message, which, size):
    message.bool_value = True
    message.byte_value = b"\xfe"
    message.char_value = 200
    message.float32_value, message.float64_value = 1.5, math.pi * which
    message.int8_value, message.int16_value, message.int32_value = -128, -32768, which
    message.uint64_value, message.int64_value = 2**64 - 1 - which, -(2**63)


def fill_UInt8MultiArray(message, which, size):
    message.layout.data_offset = which
    message.data = array.array("B", noise(which, size))
