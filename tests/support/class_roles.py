"""Roles in a class: a robot that does all a student may not have, and a student's session that looks at no rule."""

from __future__ import annotations

import json
import os
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

import zenoh

from robolink import Node
from robolink.qos import QoSProfile
from robolink.security import files
from robolink.wire import DataKey, format_key

QOS = QoSProfile(depth=10)
FAR = zenoh.Locality.REMOTE

PUBLISHED = (
    *("/cmd_vel", "/scan", "/map", "/tf", "/clock", "/odom", "/robot/mode", "/emergency_stop", "/goal_pose"),
    *("/student2/cmd_vel", "/student10/x", "/student1"),
)
HEARD = ("/cmd_vel", "/student2/cmd_vel", "/camera/image", "/rosout", "/diagnostics", "/teacher/notes", "/student1")
CALLED = (
    *("/robot/set_parameters", "/robot/set_parameters_atomically", "/reset", "/student2/ask"),
    *("/teacher/get_parameters", "/fly/_action/send_goal", "/robot/change_state"),
)
SERVED = ("/robot/get_parameters", "/reset", "/student2/ask", "/fly/_action/send_goal")
ALLOWED_TOPIC, ALLOWED_CALL, POSE, MARK = "/scan", "/robot/get_parameters", "/student1/pose", "/student1/mark"
WILD = ("**", "{domain}/**", "{domain}/*/*/*", "{domain}/cmd$*/*/*")
ADMIN = ("@/**", "@/*/router/**", "@/{domain}/**")


def key(name: str, domain: int) -> str:
    """Return the key of a topic of texts."""
    return format_key(DataKey(domain, name, "std_msgs/msg/String", "RIHS01_" + "0" * 64))


def tokens(domain: int) -> dict[str, str]:
    """Return tokens that a student may not have, by what they pretend; the last one it may have."""

    def text(kind: str, name: str, enclave: str, of: int = domain) -> str:
        start = f"@ros2_lv/{of}/ab/0/1/{kind}/{enclave}/%/robot"
        rest = f"/{name.replace('/', '%')}/std_msgs::msg::dds_::String_/RIHS01_{'0' * 64}/::,10:,:,:,,"
        return start + rest * (kind != "NN")

    return {
        "node of /robot": text("NN", "", "%robot"),
        "node of /student2": text("NN", "", "%student2"),
        "node of another domain": text("NN", "", "%student1", domain + 1),
        "publisher of /cmd_vel": text("MP", "/cmd_vel", "%student1"),
        "publisher of /scan": text("MP", "/scan", "%student1"),
        "subscription to /cmd_vel": text("MS", "/cmd_vel", "%student1"),
        "service /reset": text("SS", "/reset", "%student1"),
        "client of /robot/set_parameters": text("SC", "/robot/set_parameters", "%student1"),
        "allowed": text("MP", MARK, "%student1"),
    }


class Robot(Node):
    """Publishes, serves and calls all that a student may not have, and notes in a file what has come from it."""

    def __init__(self) -> None:
        super().__init__("robot")
        self._file, self._lock = Path(os.environ["ATTEMPTS_FILE"]), threading.Lock()
        self._found: dict[str, set[str]] = {"arrived": set(), "called": set(), "tokens": set()}
        transport, domain = self.context.transport, int(os.environ["ROS_DOMAIN_ID"])
        for of in (domain, domain + 1):
            bare: Any = vars(transport)["plain"].session
            for name in (*PUBLISHED, POSE, MARK):
                there = key(name, of)
                self._keep(
                    bare.declare_subscriber(
                        there, self._noting("arrived", str(of != domain) + name), allowed_origin=FAR
                    )
                )
            self._keep(bare.liveliness().declare_subscriber(f"@ros2_lv/{of}/**", self._note_token, history=True))
        bare.declare_queryable(key(ALLOWED_CALL, domain), lambda query: query.reply(query.key_expr, b"yes"))
        for name in CALLED:
            self._keep(bare.declare_queryable(key(name, domain), self._noting("called", name), allowed_origin=FAR))
        self._outlets = [transport.advertise(key(name, domain), QOS) for name in (*HEARD, ALLOWED_TOPIC)]
        self._asked = [key(name, domain) for name in SERVED]
        self.create_timer(0.05, self._tick)

    def _keep(self, declared: object) -> None:
        self.__dict__.setdefault("_declared", []).append(declared)

    def _noting(self, what: str, name: str) -> Callable[[Any], None]:
        def note(_: object) -> None:
            self._note(what, name)

        return note

    def _note_token(self, sample: Any) -> None:
        self._note("tokens", str(sample.key_expr))

    def _note(self, what: str, name: str) -> None:
        with self._lock:
            if name not in self._found[what]:
                self._found[what].add(name)
                files.write(
                    self._file, json.dumps({each: sorted(names) for each, names in self._found.items()}).encode()
                )

    def _tick(self) -> None:
        for outlet in self._outlets:
            outlet.put(b"robot", b"")
        for each in self._asked:
            self.context.transport.call(each, b"ask", b"", lambda _: None)


class Student:
    """A session with a student's key that looks at no rule, and does all it may not, again and again.

    Args:
        domain: Domain of the robot.
        config: Configuration of a session.
    """

    def __init__(self, domain: int, config: zenoh.Config) -> None:
        self.heard: set[str] = set()
        self.asked: set[str] = set()
        self._domain, self.session = domain, zenoh.open(config)
        bare: Any = self.session
        self._kept = [
            bare.declare_subscriber(each.format(domain=domain), self._hear, allowed_origin=FAR)
            for each in (*WILD, *(key(name, domain) for name in (*HEARD, ALLOWED_TOPIC)), key("/scan", domain + 1))
        ]
        self._kept += [
            bare.declare_queryable(key(name, domain), self._ask(name), allowed_origin=FAR) for name in SERVED
        ]
        self._kept += [bare.liveliness().declare_token(each) for each in tokens(domain).values()]

    def _hear(self, sample: Any) -> None:
        self.heard.add(str(sample.key_expr))

    def _ask(self, name: str) -> Callable[[Any], None]:
        def note(_: object) -> None:
            self.asked.add(name)

        return note

    def publish(self) -> None:
        """Publish once on all topics; the mark is the last."""
        for each in WILD:
            self.session.put(each.format(domain=self._domain), b"attack")
        for of, names in ((self._domain + 1, (POSE, "/cmd_vel")), (self._domain, (*PUBLISHED, POSE, MARK))):
            for name in names:
                self.session.put(key(name, of), b"attack")

    def answered(self, name: str) -> bool:
        """Return whether a call is answered."""
        bare: Any = self.session
        return bool(list(bare.get(name, target=zenoh.QueryTarget.ALL, timeout=5.0, allowed_destination=FAR)))
