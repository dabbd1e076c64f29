"""Names that users give to attributes of their Node: does any collide?"""

import sys

import rclpy
from probe import say
from rclpy.node import Node
from std_msgs.msg import String
from std_srvs.srv import Trigger

rclpy.init()
NAMES = "name namespace logger log clock timer timers_ rate state status pose goal goals target mode speed velocity x y z result feedback publisher subscriber subscription client server service pub sub callback callbacks group groups lock thread queue queues data buffer buffers topic topics topic_name params parameters parameter_ config options args context_ node node_name nodes graph gid host transport session inbox closed running active enabled executor_ future futures task tasks wait waiter send receive run start stop spin step update reset close open destroy shutdown setup init loop tick main process handle_ connect disconnect attach detach execute deliver origin entity entities mailbox peer peers id uuid key index counter count last_time time now dt period frequency world robot map image frame frames tf tf_buffer tf_listener listener broadcaster scan odom imu joint joints laser camera debug info warn warning error fatal get set add remove has find exists call request response interrupt ended next_id spec types hidden look_after let_go say declared descriptors overrides values events event handlers handler hooks hook watch watchers unwatch owner parent children child lost dropped overflowed limits limit guard_ store stored sleep timeout names own fields alive dead ready pending lives lived kind level cache cached base root path file files version enclave arguments remaps rules rule resolve expand discover discovered seen known".split()
bad = []
for when in ("before", "after"):
    for a in NAMES:

        class T(Node):
            def __init__(self):
                if when == "before":
                    setattr(self, a, 3)
                super().__init__("n58")
                if when == "after":
                    setattr(self, a, 3)

        try:
            n = T()
            got = []
            p = n.create_publisher(String, "t58", 1)
            n.create_subscription(String, "t58", got.append, 1)
            n.create_timer(0.01, lambda: got.append(1))
            n.declare_parameter("p", 1)
            n.set_parameters([rclpy.parameter.Parameter("p", value=2)])
            n.create_service(Trigger, "s58", lambda q, r: r)
            n.create_client(Trigger, "s58")
            n.get_logger().debug("x")
            n.get_clock().now()
            n.count_publishers("t58")
            rclpy.spin_once(n, timeout_sec=0.5)
            assert got, "nothing"
            assert getattr(n, a) == 3, "changed"
            n.destroy_node()
        except BaseException as e:
            bad.append(f"{when} {a}: {type(e).__name__} {e}")
            try:
                rclpy.try_shutdown()
                rclpy.init()
            except Exception:
                pass
for b in bad:
    say(b)
say(len(bad))
