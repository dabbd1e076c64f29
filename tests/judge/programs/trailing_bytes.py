"""Bytes behind the end of a message."""

import rclpy.serialization as S
from probe import show
from sensor_msgs.msg import JointState
from std_msgs.msg import *

H = bytes.fromhex
js = H("0001000000000000000000000100000000e1f92c00000000000000000000000000000000")
for k in (0, 1, 2, 3, 4, 5, 7, 8, 12, 16):
    show(f"JointState + {k}", lambda: S.deserialize_message(js + b"\xa5" * k, JointState) == JointState())
for k in (0, 1, 3, 4, 7, 8):
    show(f"Bool + {k}", lambda: S.deserialize_message(H("0001000001") + b"\xa5" * k, Bool))
for k in (0, 1, 3, 4, 8):
    show(f"String + {k}", lambda: S.deserialize_message(H("00010000030000006162") + b"\0" + b"\xa5" * k, String))
show("no header options", lambda: S.deserialize_message(H("0001000303000000616200"), String))
