"""A program of rclpy that does as lines of JSON on its input say, and prints answers and what arrives as such lines.

It runs by a real rclpy (Jazzy, Kilted) and by robolink, unchanged. `tests/dds/peers.py` talks to it. A request is
``{"id": 1, "do": "publish", ...}`` and its answer ``{"id": 1, "value": ...}``; all else has an "event". Times are
those of CLOCK_MONOTONIC, which all processes of a machine share.
"""

import importlib
import json
import sys
import threading
import time
import traceback
from collections import deque

import rclpy
from rclpy.action import ActionClient, ActionServer, CancelResponse
from rclpy.context import Context
from rclpy.duration import Duration
from rclpy.executors import SingleThreadedExecutor
from rclpy.parameter import Parameter
from rclpy.qos import DurabilityPolicy, HistoryPolicy, LivelinessPolicy, QoSProfile, ReliabilityPolicy
from rclpy.task import Future
from samples import made, number, right


def emit(**said):
    sys.stdout.write(json.dumps(said) + "\n")
    sys.stdout.flush()


def kind(name):
    package, group, short = name.split("/")
    return getattr(importlib.import_module(f"{package}.{group}"), short)


def profile(depth=10, reliable=True, latched=False, keep_all=False, deadline=None, lifespan=None, lease=None):
    qos = QoSProfile(
        depth=depth,
        history=HistoryPolicy.KEEP_ALL if keep_all else HistoryPolicy.KEEP_LAST,
        reliability=ReliabilityPolicy.RELIABLE if reliable else ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if latched else DurabilityPolicy.VOLATILE,
    )
    if deadline:
        qos.deadline = Duration(seconds=deadline)
    if lifespan:
        qos.lifespan = Duration(seconds=lifespan)
    if lease:
        qos.liveliness = LivelinessPolicy.AUTOMATIC
        qos.liveliness_lease_duration = Duration(seconds=lease)
    return qos


def plain(message):
    """Return a message as dicts, lists, numbers and texts."""
    if hasattr(message, "get_fields_and_field_types"):
        return {name: plain(getattr(message, name)) for name in message.get_fields_and_field_types()}
    if isinstance(message, bytes):
        return list(message)
    if isinstance(message, (str, int, float, bool)):
        return message
    return [plain(each) for each in message.tolist()] if hasattr(message, "tolist") else [plain(e) for e in message]


def filled(message, values):
    for name, value in values.items():
        setattr(message, name, value)
    return message


class Peer:
    """Its methods without an underscore are what can be requested. All runs on the thread that spins."""

    def __init__(self, name):
        rclpy.init(args=[])
        self.executor = SingleThreadedExecutor()
        self.node_ = rclpy.create_node(name, namespace="/lab")
        self.executor.add_node(self.node_)
        self.requests = deque()
        self.wake = self.node_.create_guard_condition(self._serve)
        self.publishers, self.subscriptions, self.things, self.goals, self.others = {}, {}, {}, {}, []
        emit(event="ready", at=time.monotonic())

    def read(self):
        """Take requests from the input until it ends; this runs on a thread of its own."""
        for line in sys.stdin:
            self.requests.append(json.loads(line))
            self.wake.trigger()
        self.requests.append(None)
        self.wake.trigger()

    def _serve(self):
        while self.requests:
            request = self.requests.popleft()
            if request is None:
                raise SystemExit(0)
            number_, name = request.pop("id"), request.pop("do")
            try:
                value = getattr(self, name)(**request)
            except Exception as error:
                traceback.print_exc()
                emit(id=number_, error=f"{type(error).__name__}: {error}")
                continue
            if isinstance(value, Future):
                value.add_done_callback(lambda done, number_=number_: emit(id=number_, value=done.result()))
            else:
                emit(id=number_, value=value)

    def _after(self, seconds, call):
        """Call a function once."""

        def once():
            timer.cancel()
            self.node_.destroy_timer(timer)
            call()

        timer = self.node_.create_timer(seconds, once)

    # Topics

    def publisher(self, topic, type_name, **qos):
        self.publishers[topic] = self.node_.create_publisher(kind(type_name), topic, profile(**qos)), type_name

    def subscription(self, topic, type_name, field="", **qos):
        """Print the number of each message that arrives, and whether all of its fields are as they were sent.

        Of messages that others made, print the value of a field, as "pose.position.x".
        """
        seen = set()

        def show(message):
            for name in field.split("."):
                message = getattr(message, name)
            emit(event=topic, value=plain(message), at=time.monotonic())

        def heard(message):
            now, which = time.monotonic(), number(message)
            again = which in seen
            seen.add(which)
            emit(event=topic, number=which, right=right(message, which), again=again, at=now)

        self.subscriptions[topic] = self.node_.create_subscription(
            kind(type_name), topic, show if field else heard, profile(**qos)
        )

    def publish(self, topic, first=1, last=None, size=0):
        """Publish the messages of these numbers, one after the other."""
        publisher, type_name = self.publishers[topic]
        for which in range(first, (last or first) + 1):
            publisher.publish(made(kind(type_name), which, size))

    def stream(self, topic, rate, count, first=1, size=0):
        """Publish so many a second; answer when the last one is sent."""
        publisher, type_name = self.publishers[topic]
        done, messages = Future(), [made(kind(type_name), first + index, size) for index in range(count)]

        def send():
            publisher.publish(messages.pop(0))
            if not messages:
                timer.cancel()
                done.set_result(time.monotonic())

        timer = self.node_.create_timer(1.0 / rate, send)
        return done

    def matched(self, topic):
        """Return how many others each end on a topic knows: [subscriptions of ours, publishers for ours]."""
        ours, theirs = self.publishers.get(topic), self.subscriptions.get(topic)
        return [ours[0].get_subscription_count() if ours else 0, theirs.get_publisher_count() if theirs else 0]

    def forget(self, topic):
        """Destroy what this has on a topic."""
        if entry := self.publishers.pop(topic, None):
            self.node_.destroy_publisher(entry[0])
        if subscription := self.subscriptions.pop(topic, None):
            self.node_.destroy_subscription(subscription)

    # Services

    def service(self, name, type_name):
        """Answer with the request's own fields where the response has them too, and this node's name."""

        def answer(request, response):
            for field in response.get_fields_and_field_types():
                if field in request.get_fields_and_field_types():
                    setattr(response, field, getattr(request, field))
                elif field == "message":
                    response.message = f"{self.node_.get_name()} heard {request.data}"
                elif field == "success":
                    response.success = request.data
            return response

        self.things[name] = self.node_.create_service(kind(type_name), name, answer)

    def client(self, name, type_name):
        self.things[name] = self.node_.create_client(kind(type_name), name)

    def is_ready(self, name):
        thing = self.things[name]
        return thing.server_is_ready() if isinstance(thing, ActionClient) else thing.service_is_ready()

    def call(self, name, type_name, values):
        answer = Future()
        calling = self.things[name].call_async(filled(kind(type_name).Request(), values))
        calling.add_done_callback(lambda done: answer.set_result(plain(done.result())))
        return answer

    def calls(self, name, type_name, field, values):
        """Call with each of the values in a field, all at once; answer with the field of the responses, in order."""
        answers, all_ = {}, Future()

        def keep(index, done):
            answers[index] = plain(getattr(done.result(), field))
            if len(answers) == len(values):
                all_.set_result([answers[each] for each in range(len(values))])

        for index, value in enumerate(values):
            calling = self.things[name].call_async(filled(kind(type_name).Request(), {field: value}))
            calling.add_done_callback(lambda done, index=index: keep(index, done))
        return all_

    def rounds(self, name, type_name, count):
        """Call so often, one after the other; answer with the seconds that each took."""
        took, done = [], Future()

        def again(_=None, begun=0.0):
            if begun:
                took.append(time.perf_counter() - begun)
            if len(took) == count:
                done.set_result(took)
                return
            begun = time.perf_counter()
            calling = self.things[name].call_async(kind(type_name).Request())
            calling.add_done_callback(lambda done, begun=begun: again(done, begun))

        again()
        return done

    # Actions

    def action_server(self, name, type_name):
        """Compute Fibonacci, a number every 20 ms, until it is done or canceled."""
        action = kind(type_name)

        async def execute(goal):
            feedback, sequence = action.Feedback(), [0, 1]
            while len(sequence) < goal.request.order:
                pause = Future(executor=self.executor)
                self._after(0.02, lambda: pause.set_result(None))
                await pause
                if goal.is_cancel_requested:
                    goal.canceled()
                    return filled(action.Result(), {"sequence": sequence})
                sequence.append(sequence[-1] + sequence[-2])
                feedback.sequence = sequence
                goal.publish_feedback(feedback)
            goal.succeed()
            return filled(action.Result(), {"sequence": sequence})

        accept = CancelResponse.ACCEPT
        self.things[name] = ActionServer(self.node_, action, name, execute, cancel_callback=lambda _: accept)

    def action_client(self, name, type_name):
        self.things[name] = ActionClient(self.node_, kind(type_name), name)

    def goal(self, name, type_name, order):
        """Send a goal; answer with whether it is accepted. Feedback and the result come as events."""
        answer = Future()

        def told(message):
            emit(event=f"{name} feedback", sequence=list(message.feedback.sequence))

        def ended(done):
            status, result = done.result().status, done.result().result
            emit(event=f"{name} result", status=status, sequence=list(result.sequence))

        def accepted(done):
            handle = self.goals[name] = done.result()
            if handle.accepted:
                handle.get_result_async().add_done_callback(ended)
            answer.set_result(handle.accepted)

        goal = filled(kind(type_name).Goal(), {"order": order})
        self.things[name].send_goal_async(goal, feedback_callback=told).add_done_callback(accepted)
        return answer

    def cancel(self, name):
        """Cancel the last goal; answer with how many are canceling."""
        answer = Future()
        canceling = self.goals[name].cancel_goal_async()
        canceling.add_done_callback(lambda done: answer.set_result(len(done.result().goals_canceling)))
        return answer

    # Parameters

    def declare(self, **values):
        for name, value in values.items():
            self.node_.declare_parameter(name, value)

    def parameter(self, name):
        return plain(self.node_.get_parameter(name).value)

    def remote_parameters(self, node, verb, names=None, values=None):
        """List, get or set parameters of another node, by a client of its services."""
        from rclpy.parameter_client import AsyncParameterClient

        client = self.things.setdefault(f"parameters of {node}", AsyncParameterClient(self.node_, node))
        if not client.services_are_ready():
            return None
        answer = Future()
        if verb == "list":
            calling = client.list_parameters()
        elif verb == "get":
            calling = client.get_parameters(names)
        else:
            calling = client.set_parameters([Parameter(name, value=value) for name, value in values.items()])
        calling.add_done_callback(lambda done: answer.set_result(plain(done.result())))
        return answer

    # The graph

    def nodes(self):
        return sorted(
            f"{namespace.rstrip('/')}/{name}" for name, namespace in self.node_.get_node_names_and_namespaces()
        )

    def topics(self):
        return dict(self.node_.get_topic_names_and_types())

    def services_of(self, name, namespace):
        return dict(self.node_.get_service_names_and_types_by_node(name, namespace))

    def topics_of(self, name, namespace):
        return [
            dict(self.node_.get_publisher_names_and_types_by_node(name, namespace)),
            dict(self.node_.get_subscriber_names_and_types_by_node(name, namespace)),
        ]

    def clients_of(self, name, namespace):
        return dict(self.node_.get_client_names_and_types_by_node(name, namespace))

    def endpoints(self, topic):
        """Return who publishes and who subscribes, with type, hash and QoS."""
        publishers = self.node_.get_publishers_info_by_topic(topic)
        return [self._ends(publishers), self._ends(self.node_.get_subscriptions_info_by_topic(topic))]

    def _ends(self, found):
        ends = []
        for each in found:
            qos = each.qos_profile
            ends.append(
                {
                    "node": f"{each.node_namespace.rstrip('/')}/{each.node_name}",
                    "type": each.topic_type,
                    "hash": str(each.topic_type_hash),
                    "reliability": qos.reliability.name,
                    "durability": qos.durability.name,
                    "liveliness": qos.liveliness.name,
                    "deadline": qos.deadline.nanoseconds,
                    "lifespan": qos.lifespan.nanoseconds,
                    "lease": qos.liveliness_lease_duration.nanoseconds,
                    "gid": bytes(each.endpoint_gid).hex(),
                }
            )
        return sorted(ends, key=lambda end: end["node"])

    def crowd(self, nodes, topics, prefix):
        """Make so many more nodes, each in a participant of its own, with publishers and subscriptions."""
        string = kind("std_msgs/msg/String")
        for index in range(nodes):
            context = Context()
            rclpy.init(args=[], context=context)
            node = rclpy.create_node(f"{prefix}{index}", namespace="/crowd", context=context)
            for topic in range(topics):
                node.create_publisher(string, f"{prefix}{index}_{topic}", 10)
                node.create_subscription(string, f"{prefix}{(index + 1) % nodes}_{topic}", lambda _: None, 10)
            self.others.append((context, node))
        return time.monotonic()


def main():
    peer = Peer(sys.argv[1])
    threading.Thread(target=peer.read, daemon=True).start()
    try:
        peer.executor.spin()
    except KeyboardInterrupt:
        pass
    rclpy.try_shutdown()


if __name__ == "__main__":
    main()
