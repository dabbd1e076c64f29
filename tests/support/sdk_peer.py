"""Remote-controlled process with zenoh-ros2-sdk, a third-party ROS 2 peer; tests use it through `Sdk`.

It would fetch the definitions of types from the net: it gets them from here, and a look elsewhere ends the process.
Run as a program, this file is that process: it reads requests and prints answers and messages, all as lines of JSON.
"""

from __future__ import annotations

import contextlib
import json
import os
import queue
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path
from types import TracebackType
from typing import Any

PATIENCE = 30.0

DEFINITIONS = {
    "builtin_interfaces/msg/Time": "int32 sec\nuint32 nanosec\n",
    "std_msgs/msg/Header": "builtin_interfaces/Time stamp\nstring frame_id\n",
    "std_msgs/msg/String": "string data\n",
    "geometry_msgs/msg/Vector3": "float64 x\nfloat64 y\nfloat64 z\n",
    "geometry_msgs/msg/Twist": "Vector3 linear\nVector3 angular\n",
    "sensor_msgs/msg/LaserScan": """
        std_msgs/Header header
        float32 angle_min
        float32 angle_max
        float32 angle_increment
        float32 time_increment
        float32 scan_time
        float32 range_min
        float32 range_max
        float32[] ranges
        float32[] intensities
    """,
    "sensor_msgs/msg/Image": """
        std_msgs/Header header
        uint32 height
        uint32 width
        string encoding
        uint8 is_bigendian
        uint32 step
        uint8[] data
    """,
}
QUIET = {"PYTHONWARNINGS": "ignore", "GIT_PYTHON_REFRESH": "quiet", "ZENOH_CONFIG_OVERRIDE": ""}
ADD_TWO_INTS = ("int64 a\nint64 b\n", "int64 sum\n")

_ENDED = "ended"


class Sdk:
    """A running process of the SDK, on a domain, at the router that listens on this port."""

    def __init__(self, port: int, domain: int) -> None:
        self._process = subprocess.Popen(
            [sys.executable, __file__, str(port)],
            env={**os.environ, **QUIET, "ROS_DOMAIN_ID": str(domain)},
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        self._answers: queue.SimpleQueue[Any] = queue.SimpleQueue()
        self.messages: queue.SimpleQueue[tuple[str, Any]] = queue.SimpleQueue()
        """What arrived, each with its topic."""
        self.errors: list[str] = []
        """What it wrote to standard error."""
        self._threads = [threading.Thread(target=each, daemon=True) for each in (self._follow, self._follow_errors)]
        for thread in self._threads:
            thread.start()

    def _follow(self) -> None:
        assert self._process.stdout
        for line in self._process.stdout:
            if not line.endswith("\n"):  # it was killed as it wrote
                break
            said = json.loads(line)
            if "message" in said:
                self.messages.put((said["topic"], said["message"]))
            else:
                self._answers.put(said["answer"])
        self._answers.put(_ENDED)
        self.messages.put(("", _ENDED))

    def _follow_errors(self) -> None:
        assert self._process.stderr
        self.errors += map(str.rstrip, self._process.stderr)

    def start(self, request: str, **arguments: Any) -> None:
        """Have it do something whose answer is taken by `answer` later."""
        assert self._process.stdin
        self._process.stdin.write(json.dumps([request, arguments]) + "\n")
        self._process.stdin.flush()

    def answer(self) -> Any:
        """The answer to the oldest request that has not been taken."""
        return self._taken(self._answers, PATIENCE)

    def message(self, topic: str, patience: float = PATIENCE) -> Any:
        """The next message on this topic: dicts, lists and numbers, bytes in hex. Raises queue.Empty if none comes."""
        while True:
            found, message = self._taken(self.messages, patience)
            if found == topic:
                return message

    def _taken(self, answers: queue.SimpleQueue[Any], patience: float) -> Any:
        answer = answers.get(timeout=patience)
        if answer in (_ENDED, ("", _ENDED)):
            self._threads[1].join(PATIENCE)
            raise AssertionError(f"the SDK has ended: {self.errors}")
        return answer

    def ask(self, request: str, **arguments: Any) -> Any:
        """Have it do something, and give the answer: a method of `_Worker`."""
        self.start(request, **arguments)
        return self.answer()

    def __enter__(self) -> Sdk:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        assert self._process.stdin
        with contextlib.suppress(BrokenPipeError):
            self._process.stdin.close()
        try:
            self._process.wait(PATIENCE)
        except subprocess.TimeoutExpired:
            self._process.kill()
        for thread in self._threads:
            thread.join(PATIENCE)
        for stream in (self._process.stdout, self._process.stderr):
            assert stream
            stream.close()


class _Worker:
    """What the process can do; all that the SDK is used for."""

    def __init__(self, port: int, definitions: str) -> None:
        import zenoh_ros2_sdk

        self.sdk, self.port = zenoh_ros2_sdk, port
        zenoh_ros2_sdk.get_registry(definitions)
        self.session = zenoh_ros2_sdk.ZenohSession.get_instance(router_port=port)
        for name, text in DEFINITIONS.items():
            self.session.register_message_type(text, name)
        self.publishers: dict[str, Any] = {}
        self.kept: list[Any] = []

    def zid(self) -> str:
        """The id of its session."""
        return str(self.session.session_id)

    def publisher(self, topic: str, type_name: str, node: str, namespace: str = "/", qos: str | None = None) -> str:
        """Make a publisher; gives the key on which it publishes."""
        made = self.sdk.ROS2Publisher(
            topic,
            type_name,
            DEFINITIONS[type_name],
            node,
            namespace,
            router_port=self.port,
            qos=qos,
            strict_zenoh_qos=True,
        )
        self.publishers[topic] = made
        return str(made.keyexpr)

    def publish(self, topic: str, values: dict[str, Any]) -> None:
        """Publish, as soon as there is somebody who subscribes."""
        publisher = self.publishers[topic]
        deadline = time.monotonic() + PATIENCE
        while not publisher.pub.matching_status.matching:
            assert time.monotonic() < deadline, f"nobody subscribes to {topic}"
            time.sleep(0.002)
        publisher.publish(**self._fields(publisher.msg_type, values))

    def subscribe(self, topic: str, type_name: str, node: str, namespace: str = "/", qos: str | None = None) -> str:
        """Print what arrives; gives the key."""

        def show(message: Any) -> None:
            _print({"topic": topic, "message": _plain(message)})

        made = self.sdk.ROS2Subscriber(
            topic, type_name, show, DEFINITIONS[type_name], node, namespace, router_port=self.port, qos=qos
        )
        self.kept.append(made)
        return str(made.keyexpr)

    def serve(self, service: str, node: str) -> str:
        """Add two ints for whoever asks; gives the key."""

        def add(request: Any) -> Any:
            return made.response_msg_class(sum=request.a + request.b)

        made = self.sdk.ROS2ServiceServer(
            service, "example_interfaces/srv/AddTwoInts", add, *ADD_TWO_INTS, node, router_port=self.port
        )
        self.kept.append(made)
        return str(made.keyexpr)

    def client(self, service: str, node: str) -> str:
        """Make a client of AddTwoInts; gives the key."""
        made = self.sdk.ROS2ServiceClient(
            service, "example_interfaces/srv/AddTwoInts", *ADD_TWO_INTS, node, router_port=self.port, timeout=PATIENCE
        )
        self.publishers[service] = made
        return str(made.keyexpr)

    def call(self, service: str, values: dict[str, Any]) -> Any:
        """Call; None when no answer came."""
        response = self.publishers[service].call(**values)
        return response and _plain(response)

    def topics(self) -> Any:
        """All topics and their types."""
        return self.sdk.get_topic_names_and_types(router_port=self.port)

    def services(self) -> Any:
        """All services and their types."""
        return self.sdk.get_service_names_and_types(router_port=self.port)

    def info(self, topic: str) -> Any:
        """Who publishes and subscribes: node, namespace, type, hash and QoS of each."""
        found = self.sdk.get_topic_info(topic, router_port=self.port, verbose=True)
        return found and {"publishers": _plain_all(found.publishers), "subscribers": _plain_all(found.subscribers)}

    def service_info(self, service: str) -> Any:
        """Who serves and calls."""
        found = self.sdk.get_service_info(service, router_port=self.port, verbose=True)
        return found and {"servers": _plain_all(found.servers), "clients": _plain_all(found.clients)}

    def look_up(self, type_name: str) -> Any:
        """Make it need a definition that it has not got."""
        return self.sdk.load_message_type(type_name)

    def _fields(self, name: str, values: dict[str, Any]) -> dict[str, Any]:
        kinds = self.session.store.fielddefs[name][1]
        return {field: self._made(kind, values[field]) for field, kind in kinds}

    def _made(self, kind: Any, value: Any) -> Any:
        import numpy as np
        from rosbags.interfaces import Nodetype

        if kind[0] is Nodetype.NAME:
            return self.session.store.types[kind[1]](**self._fields(kind[1], value))
        if kind[0] is Nodetype.BASE:
            return value
        base = kind[1][0][1][0]
        return np.frombuffer(bytes.fromhex(value), np.uint8) if base == "uint8" else np.array(value, base)


def _plain(message: Any) -> Any:
    """Dicts, lists and numbers; bytes in hex."""
    if hasattr(message, "__msgtype__"):
        return {name: _plain(value) for name, value in vars(message).items() if name != "__msgtype__"}
    if hasattr(message, "tobytes"):
        return message.tobytes().hex() if message.dtype == "uint8" else message.tolist()
    return message


def _plain_all(found: list[Any]) -> list[Any]:
    return [vars(each) for each in found]


def _print(said: dict[str, Any]) -> None:
    sys.stdout.write(json.dumps(said) + "\n")
    sys.stdout.flush()


def _refuse_the_net(event: str, arguments: tuple[Any, ...]) -> None:
    """An audit hook: no process may be started (git), and no other machine be spoken to from Python."""
    if event in ("subprocess.Popen", "os.system", "os.posix_spawn", "socket.getaddrinfo", "socket.connect"):
        sys.stderr.write(f"the SDK reaches out: {event} {arguments[:2]}\n")
        sys.stderr.flush()
        os._exit(3)


def _write_definitions(folder: str) -> None:
    for name, text in DEFINITIONS.items():
        path = Path(folder, *name.split("/")).with_suffix(".msg")
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)


def main() -> None:
    with tempfile.TemporaryDirectory() as folder:
        os.environ["ZENOH_ROS2_SDK_CACHE"] = folder
        _write_definitions(folder)
        worker = _Worker(int(sys.argv[1]), folder)
        sys.addaudithook(_refuse_the_net)
        for line in sys.stdin:
            request, arguments = json.loads(line)
            _print({"answer": getattr(worker, request)(**arguments)})
    os._exit(0)  # the SDK's threads would keep it from ending by itself


if __name__ == "__main__":
    main()
