"""The launch key `enclave`: each node has the keys and rights of its enclave, and mistakes are found early."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from robolink.arguments.command_line import parse_arguments
from robolink.bag.reader import open_bag
from robolink.exceptions import DocumentError
from robolink.launch.entry import Entry
from robolink.launch.looking.look import End, Look
from robolink.launch.looking.validate import Report, judged
from robolink.launch.planning import plan, processes
from robolink.launch.reading.entries import read_launch_file
from robolink.security.keystore import Keystore
from robolink.security.policy import Profile, Rule
from tests.support.domains import free_domain
from tests.support.launchfiles import make_workspace

SYSTEM = """
nodes:
- {node: mine, name: robot, enclave: /robot}
- {node: mine, name: driver, enclave: /driver}
"""


@pytest.fixture
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    for name in [each for each in os.environ if each.startswith("ROS_")]:
        monkeypatch.delenv(name)
    return make_workspace(tmp_path, monkeypatch)


@pytest.fixture
def store(home: Path, monkeypatch: pytest.MonkeyPatch) -> Keystore:
    pytest.importorskip("cryptography", reason="needs the extra `security`")
    store = Keystore(home / "keys")
    store.create()
    for name in ("/robot", "/driver"):
        store.create_enclave(name)
    store.permit_profiles("/driver", [Profile("/", "driver", [Rule("publish", True, "/cmd_vel")])])
    monkeypatch.setenv("ROS_SECURITY_ENABLE", "true")
    monkeypatch.setenv("ROS_SECURITY_STRATEGY", "Enforce")
    monkeypatch.setenv("ROS_SECURITY_KEYSTORE", str(store.path))
    return store


def entries(home: Path, text: str) -> list[Entry]:
    return read_launch_file(home / "configs" / "lap.yaml", {}, text=text)


def found(home: Path, text: str, **ends: list[tuple[str, str]]) -> Report:
    looks = {
        name: Look([f"/{name}"], [End(kind, topic, "std_msgs/msg/String", "", f"/{name}") for kind, topic in each])
        for name, each in ends.items()
    }
    return judged(entries(home, text), looks)


def test_a_node_has_its_own_enclave_or_that_of_its_group(home: Path) -> None:
    text = """
groups:
- enclave: /class
  nodes:
  - {node: mine, name: a}
  - {node: mine, count: 2, name: "s{i}", enclave: "/student{i}"}
  - {node: mine, name: none, enclave: ""}
  - {run: [python], name: helper}
"""
    said = {each.name: parse_arguments(list(each.argv)).enclave for each in plan(home / "lap.yaml", text=text)}
    assert said == {"a": "/class", "s0": "/student0", "s1": "/student1", "none": None, "helper": None}


def test_nodes_of_different_enclaves_do_not_share_a_process(home: Path) -> None:
    shared = "nodes: [{{node: mine, process: p, enclave: /a}}, {{node: mine, name: b, process: p{}}}]\n"
    with pytest.raises(DocumentError) as caught:
        processes(entries(home, shared.format(", enclave: /b")))
    assert str(caught.value).endswith(
        "1:91: nodes[1].enclave: 'mine' runs in the same process, and has another `enclave`: a process has only one"
    )
    with pytest.raises(DocumentError, match="'mine' runs in the same process, and has another `enclave`"):
        processes(entries(home, shared.format("")))
    [process] = processes(entries(home, shared.format(", enclave: /a")))
    assert [each.args[-2:] for each in process.members] == [["--enclave", "/a"]] * 2


def test_an_enclave_without_keys_is_found(home: Path, store: Keystore) -> None:
    [mistake] = found(home, SYSTEM.replace("/driver", "/drivr")).mistakes
    assert str(mistake) == (
        f"{home}/configs/lap.yaml:4:39: nodes[1].enclave: 'driver' cannot be started: enclave '/drivr' has no keys in "
        f"{store.path} (did you mean '/driver'?): make them with "
        "'robolink security create_enclave KEYSTORE /drivr', or name another by ROS_SECURITY_ENCLAVE_OVERRIDE"
    )
    assert "enclave '/' has no keys" in str(found(home, "nodes: [node: mine]\n").mistakes[0])


def test_what_an_enclave_may_not_do_is_found(home: Path, store: Keystore) -> None:
    ends = [("MP", "/cmd_vel"), ("MS", "/scan"), ("SS", "/driver/get_parameters"), ("SC", "/reset"), ("MP", "/rosout")]
    report = found(home, SYSTEM, robot=ends, driver=ends)
    place, source = f"{home}/configs/lap.yaml:4:39: nodes[1].enclave: 'driver': enclave '/driver' may not", store.path
    assert [str(each) for each in report.mistakes] == [
        f"{place} {verb}: no rule allows it ({source / 'enclaves' / 'driver' / 'permissions.xml'})"
        for verb in ("subscribe to /scan", "call /reset")
    ]


def test_what_the_environment_says_otherwise_is_noted(
    home: Path, store: Keystore, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("ROS_SECURITY_ENCLAVE_OVERRIDE", "/robot")
    report = found(home, SYSTEM, driver=[("MS", "/scan")])
    assert report.mistakes == []
    note = "driver gets the enclave '/robot' of ROS_SECURITY_ENCLAVE_OVERRIDE, and not '/driver'"
    assert note in report.notes
    monkeypatch.setenv("ROS_SECURITY_ENABLE", "false")
    report = found(home, SYSTEM)
    assert report.mistakes == []
    assert "enclaves were not looked into: ROS_SECURITY_ENABLE is not true" in report.notes


OPEN = """
nodes:
- {node: mine, name: robot}
- {node: mine, name: camera, env: {ROS_SECURITY_ENABLE: false, ROS_SECURITY_STRATEGY: Permissive}}
- {run: [python], name: helper, env: {ROS_SECURITY_ENABLE: ""}}
"""


def test_who_is_without_security_is_told(home: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert not any("security" in note for note in found(home, OPEN).notes), "nobody has any"
    monkeypatch.setenv("ROS_SECURITY_ENABLE", "True")
    off = "security is off for camera, helper: the launch file's `env` sets ROS_SECURITY_ENABLE"
    weak = "security does not insist on keys for camera: the launch file's `env` sets ROS_SECURITY_STRATEGY"
    notes = found(home, OPEN).notes
    assert off in notes
    assert weak not in notes, "nobody does"
    monkeypatch.setenv("ROS_SECURITY_STRATEGY", "Enforce")
    notes = found(home, OPEN).notes
    assert off in notes
    assert weak in notes
    assert not any("launch file's" in note for note in found(home, SYSTEM).notes)


@pytest.mark.processes
def test_a_launch_tells_who_is_without_security(home: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    text = "nodes: [{run: [python, --version], env: {ROS_SECURITY_ENABLE: false}}]\n"
    (home / "configs" / "open.yaml").write_text(text, encoding="utf-8")
    monkeypatch.setenv("ROS_SECURITY_ENABLE", "true")
    command = [sys.executable, "-m", "robolink", "launch", "open"]
    done = subprocess.run(command, cwd=home, capture_output=True, text=True, check=False, timeout=300)
    said = done.stdout + done.stderr
    assert said.count("security is off for python: the launch file's `env` sets ROS_SECURITY_ENABLE") == 1, said


ROBOT = """
from robolink import Node
from robolink.interfaces.std_msgs.msg import String
from robolink.qos import DurabilityPolicy, QoSProfile

class Robot(Node):
    def __init__(self):
        super().__init__("robot")
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.publisher = self.create_publisher(String, "/map", latched)
        self.publisher.publish(String(data="seen"))
"""
STUDENT = """
from robolink import Node
from robolink.interfaces.std_msgs.msg import String
from robolink.qos import DurabilityPolicy, QoSProfile

class Student(Node):
    def __init__(self):
        super().__init__("student")
        try:
            self.create_publisher(String, "/cmd_vel", 10)
        except PermissionError as error:
            print(error, flush=True)
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.create_subscription(String, "/map", self.hear, latched)

    def hear(self, message):
        print("the robot is", message.data, flush=True)
        raise SystemExit
"""
CLASS = """
nodes:
- {node: robot, enclave: /robot}
- {node: student, namespace: student1, enclave: /student1, start_after: {topic: /map}}
"""


@pytest.fixture
def domain() -> Iterator[int]:
    with free_domain() as domain:
        yield domain


@pytest.mark.processes
def test_a_class_and_its_robot_are_launched_together(home: Path, domain: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Each with its own session; the launcher, which waits for a topic, has one too."""
    pytest.importorskip("cryptography", reason="needs the extra `security`")
    for name, text in {"nodes/robot.py": ROBOT, "nodes/student.py": STUDENT, "configs/class.yaml": CLASS}.items():
        (home / name).write_text(text, encoding="utf-8")
    monkeypatch.setenv("ROS_DOMAIN_ID", str(domain))
    robolink = [sys.executable, "-m", "robolink"]
    made = subprocess.run([*robolink, "security", "class", "lab", "--students", "1"], cwd=home, check=False)
    assert made.returncode == 0
    environ = {"ENABLE": "true", "STRATEGY": "Enforce", "KEYSTORE": str(home / "lab" / "keys")}
    whole = {**os.environ, **{f"ROS_SECURITY_{name}": value for name, value in environ.items()}}
    command = [*robolink, "launch", "class"]
    done = subprocess.run(command, cwd=home, env=whole, capture_output=True, text=True, check=False, timeout=300)
    said = done.stdout + done.stderr
    assert "the robot is seen" in said, said
    assert "enclave '/student1' may not publish /cmd_vel" in said
    recorded = [*command, "--record", "bag"]
    viewed = [*recorded, "--view"]
    refused = subprocess.run(viewed, cwd=home, env=whole, capture_output=True, text=True, check=False, timeout=300)
    [line] = refused.stderr.splitlines()
    assert "--enclave NAME gives the recorder and the view keys: enclave '/' has no keys in" in line
    assert refused.stdout == ""
    recorded = [*recorded, "--enclave", "/teacher"]
    done = subprocess.run(recorded, cwd=home, env=whole, capture_output=True, text=True, check=False, timeout=300)
    assert "the robot is seen" in done.stdout + done.stderr, done.stdout + done.stderr
    assert "has no keys" not in done.stdout + done.stderr
    with open_bag(home / "bag") as bag:
        assert [each.topic for each in bag.messages(["/map"])] == ["/map"]
    checked = subprocess.run(
        [*command, "--validate"], cwd=home, env=whole, capture_output=True, text=True, check=False, timeout=300
    )
    assert checked.stderr == ""
    [mistake] = checked.stdout.splitlines()
    assert (
        "class.yaml:4:49: nodes[1].enclave: 'student1/student': enclave '/student1' may not publish /cmd_vel" in mistake
    )
