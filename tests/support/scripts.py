"""Typical rclpy programs for tests of hosts: a service and its client, threads, actions and frames."""

SERVER = """
import rclpy
from rclpy.node import Node
from example_interfaces.srv import AddTwoInts

class Adder(Node):
    def __init__(self):
        super().__init__("adder")
        self.create_service(AddTwoInts, "add", self.add)

    def add(self, request, response):
        response.sum = request.a + request.b
        return response

def main():
    rclpy.init()
    node = Adder()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        node.get_logger().info("interrupted")
    finally:
        node.destroy_node()
        rclpy.shutdown()

if __name__ == "__main__":
    main()
"""


CLIENT = """
import sys, time
import rclpy
from example_interfaces.srv import AddTwoInts
from std_msgs.msg import Int32

def main():
    rclpy.init()
    node = rclpy.create_node("asker")
    numbers = node.create_publisher(Int32, "numbers", 10)
    client = node.create_client(AddTwoInts, "add")
    while not client.wait_for_service(timeout_sec=1.0):
        node.get_logger().info("waiting")
    begin, total = time.time(), 0
    for n in range(5):
        future = client.call_async(AddTwoInts.Request(a=n, b=n))
        rclpy.spin_until_future_complete(node, future)
        total += future.result().sum
        numbers.publish(Int32(data=total))
        time.sleep(0.1)
    node.get_logger().info(f"took {time.time() - begin:.3f} s")
    rclpy.shutdown()
    return 3

if __name__ == "__main__":
    sys.exit(main())
"""


THREADED = """
import threading
import rclpy
from std_msgs.msg import Int32

rclpy.init()
node = rclpy.create_node("threaded")
numbers = node.create_publisher(Int32, "numbers", 10)
heard = []
node.create_subscription(Int32, "numbers", lambda message: heard.append(message.data), 10)
thread = threading.Thread(target=rclpy.spin, args=(node,), daemon=True)
thread.start()
rate = node.create_rate(10)
for n in range(20):
    numbers.publish(Int32(data=n))
    rate.sleep()
assert heard == list(range(20)), heard
rclpy.shutdown()
thread.join()
"""


PARALLEL = """
import threading, time
import rclpy
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node
from example_interfaces.srv import AddTwoInts
from std_msgs.msg import Int32

class Parallel(Node):
    def __init__(self):
        super().__init__("parallel")
        group = ReentrantCallbackGroup()
        self.numbers = self.create_publisher(Int32, "numbers", 10)
        self.client = self.create_client(AddTwoInts, "add", callback_group=group)
        self.client.wait_for_service()
        self.ticks = 0
        self.create_timer(1.0, self.ask, callback_group=group)
        self.create_timer(0.1, self.tick, callback_group=group)

    def tick(self):
        self.ticks += 1

    def ask(self):
        first = self.client.call(AddTwoInts.Request(a=1, b=self.ticks))
        done = threading.Event()
        future = self.client.call_async(AddTwoInts.Request(a=100, b=0))
        future.add_done_callback(lambda _: done.set())
        assert done.wait(5.0)
        time.sleep(0.35)
        self.numbers.publish(Int32(data=first.sum + future.result().sum + 1000 * self.ticks))

def main():
    rclpy.init()
    executor = MultiThreadedExecutor(4)
    executor.add_node(Parallel())
    try:
        executor.spin()
    except KeyboardInterrupt:
        pass

main()
"""


MIXED = """
import threading, time
import rclpy
from rclpy.action import ActionClient, ActionServer
from rclpy.duration import Duration
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node
from rclpy.time import Time
from example_interfaces.action import Fibonacci
from geometry_msgs.msg import TransformStamped
from tf2_ros import Buffer, TransformBroadcaster, TransformListener

class Server(Node):
    def __init__(self):
        super().__init__("server")
        self.server = ActionServer(self, Fibonacci, "fibonacci", self.count)
        self.frames = TransformBroadcaster(self)
        self.create_timer(0.1, self.send)

    def send(self):
        frame = TransformStamped()
        frame.header.stamp = self.get_clock().now().to_msg()
        frame.header.frame_id, frame.child_frame_id = "map", "base"
        self.frames.sendTransform(frame)

    def count(self, goal):
        numbers = [0, 1]
        for _ in range(goal.request.order):
            numbers.append(numbers[-1] + numbers[-2])
            goal.publish_feedback(Fibonacci.Feedback(sequence=numbers))
            time.sleep(0.2)
        goal.succeed()
        return Fibonacci.Result(sequence=numbers)

rclpy.init()
executor = MultiThreadedExecutor(2)
executor.add_node(Server())
threading.Thread(target=executor.spin, daemon=True).start()
asks, goals = rclpy.create_node("asks"), rclpy.create_node("goals")
buffer = Buffer()
listener = TransformListener(buffer, asks, spin_thread=True)
found = buffer.lookup_transform("map", "base", Time(), timeout=Duration(seconds=2.0))
assert found.header.stamp.sec == 1 and found.header.stamp.nanosec == 100000000
client = ActionClient(goals, Fibonacci, "fibonacci")
assert client.wait_for_server(timeout_sec=3.0)
fed = []
sent = client.send_goal_async(Fibonacci.Goal(order=5), feedback_callback=lambda back: fed.append(back))
rclpy.spin_until_future_complete(goals, sent)
result = sent.result().get_result_async()
rclpy.spin_until_future_complete(goals, result)
assert list(result.result().result.sequence) == [0, 1, 1, 2, 3, 5, 8] and len(fed) == 5
assert time.time() == 2.1, time.time()
rclpy.shutdown()
"""


SCRIPTS = {"server": SERVER, "client": CLIENT, "threaded": THREADED, "parallel": PARALLEL, "mixed": MIXED}
