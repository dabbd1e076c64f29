"""The rclpy program at each end of `benchmarks/dds_wifi.py`, which obeys lines of its standard input."""

PROGRAM = """
import array, json, sys, threading, time
import rclpy
from geometry_msgs.msg import Twist
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import Image, LaserScan
from std_srvs.srv import SetBool

started = time.monotonic()
role = sys.argv[1]
rclpy.init()
node = rclpy.create_node(role)
KINDS = {"twist": Twist, "scan": LaserScan, "image": Image}
publishers, messages, heard, subscriptions = {}, {}, {}, {}


def made(kind, size):
    if kind == "twist":
        return Twist()
    if kind == "scan":
        return LaserScan(ranges=[1.5] * size, intensities=[2.5] * size)
    return Image(data=array.array("B", bytes(size)))


def stamp(message, number):
    now = time.monotonic()
    if isinstance(message, Twist):
        message.linear.x, message.linear.y = now, float(number)
    else:
        message.header.frame_id = "%r %d" % (now, number)


def stamped(message):
    if isinstance(message, Twist):
        return message.linear.x, int(message.linear.y)
    now, number = message.header.frame_id.split()
    return float(now), int(number)


def profile(order):
    return 10 if order["reliable"] else qos_profile_sensor_data


def advertise(order):
    publishers[order["topic"]] = node.create_publisher(KINDS[order["kind"]], order["topic"], profile(order))
    messages[order["topic"]] = made(order["kind"], order["size"])
    deadline = time.monotonic() + 20
    while not publishers[order["topic"]].get_subscription_count() and time.monotonic() < deadline:
        time.sleep(0.01)
    return True


def publish(order):
    refused = []
    publisher, message, begun = publishers[order["topic"]], messages[order["topic"]], time.monotonic()
    for number in range(order["count"]):
        time.sleep(max(0.0, begun + number / order["rate"] - time.monotonic()))
        stamp(message, number)
        try:
            publisher.publish(message)
        except Exception as error:  # Fast DDS: "cannot publish data", where the link cannot take what is sent again
            refused.append(str(error))
    if refused:
        print(f"{role}: {len(refused)} of {order['count']} publish() raised: {refused[0]}", file=sys.stderr)
    return True


def retire(order):
    node.destroy_publisher(publishers.pop(order["topic"]))
    return True


def listen(order):
    found = heard[order["topic"]] = {}

    def note(message):
        sent, number = stamped(message)
        found.setdefault(number, time.monotonic() - sent)

    subscriptions[order["topic"]] = node.create_subscription(
        KINDS[order["kind"]], order["topic"], note, profile(order)
    )
    return True


def report(order):
    found, deadline = heard[order["topic"]], time.monotonic() + order["patience"]
    while len(found) <= order["last"] and time.monotonic() < deadline:
        time.sleep(0.01)
    node.destroy_subscription(subscriptions.pop(order["topic"]))
    return list(found.values())


def call(order):
    late = []
    for _ in range(order["count"]):
        begun, done = time.monotonic(), threading.Event()
        future = client.call_async(SetBool.Request(data=True))
        future.add_done_callback(lambda _: done.set())
        if done.wait(order["patience"]):
            late.append(time.monotonic() - begun)
    return late


def meet(order):
    deadline = started + order["patience"]
    while not first and time.monotonic() < deadline:
        time.sleep(0.005)
    while not client.service_is_ready() and time.monotonic() < deadline:
        time.sleep(0.005)
    call({"count": 1, "patience": order["patience"]})
    return {"heard": (first or [deadline])[0] - started, "answered": time.monotonic() - started}


def answer(request, response):
    response.success = request.data
    return response


first = []
if role == "robot":
    node.create_service(SetBool, "set", answer)
    beat = node.create_publisher(Twist, "beat", 10)
    node.create_timer(0.05, lambda: beat.publish(Twist()))
else:
    client = node.create_client(SetBool, "set")
    node.create_subscription(Twist, "beat", lambda _: first or first.append(time.monotonic()), 10)
threading.Thread(target=rclpy.spin, args=(node,), daemon=True).start()
DO = {"advertise": advertise, "publish": publish, "retire": retire, "listen": listen, "heard": report, "call": call}
DO["meet"] = meet
for text in sys.stdin:
    order = json.loads(text)
    print(json.dumps(DO[order["do"]](order)), flush=True)
"""
