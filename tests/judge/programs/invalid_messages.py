"""Messages with wrong fields, made and published."""

import rclpy
import rclpy.serialization as S
from geometry_msgs.msg import *
from probe import show, typed
from sensor_msgs.msg import *
from std_msgs.msg import *

rclpy.init()
n = rclpy.create_node("n39")


def s(label, f):
    typed(label, lambda: S.serialize_message(f()).hex())


def mut(m, **k):
    for a, b in k.items():
        object.__setattr__(m, "_" + a, b)
    return m


m = PoseArray()
m.poses.append(3)
s("wrong element", lambda: m)
m2 = JointState()
m2.name.append(3)
s("wrong string element", lambda: m2)
p = n.create_publisher(PoseArray, "t39", 1)
typed("publish wrong element", lambda: p.publish(m))


class Sub(Point):
    pass


q = n.create_publisher(Point, "p39", 1)
show("publish subclass", lambda: q.publish(Sub(x=1.0)))


class Duck:
    x = 1.0
    y = 0.0
    z = 0.0


typed("publish duck", lambda: q.publish(Duck()))
t = Twist()
typed("int assign nested", lambda: setattr(t.linear, "x", 1))
show("value", lambda: t.linear.x)
typed("-O independent", lambda: setattr(Point(), "x", "1"))
show("bool array elem", lambda: LaserScan(ranges=[True]).ranges[0])
