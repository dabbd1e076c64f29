"""A program that starts processes of multiprocessing and subprocess."""

import multiprocessing as mp
import time

import rclpy
from probe import say, until
from std_msgs.msg import String


def child(q):
    rclpy.init()
    n = rclpy.create_node("child74")
    got = []
    n.create_subscription(String, "t74", lambda m: got.append(m.data), 10)
    until(n, lambda: got, 6)
    q.put(got[:1])
    n.destroy_node()
    rclpy.shutdown()


if __name__ == "__main__":
    for method in ("fork", "spawn"):
        c = mp.get_context(method)
        q = c.Queue()
        p = c.Process(target=child, args=(q,))
        p.start()
        rclpy.init()
        n = rclpy.create_node("parent74")
        pub = n.create_publisher(String, "t74", 10)
        t = time.monotonic()
        while q.empty() and time.monotonic() - t < 8:
            pub.publish(String(data="hi"))
            rclpy.spin_once(n, timeout_sec=0.05)
        say(method, q.get(timeout=1) if not q.empty() else "nothing")
        p.join(5)
        say(p.exitcode)
        n.destroy_node()
        rclpy.shutdown()
