"""Programs as people write them for rclpy run unchanged under `robolink run`: each in a process of its own."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path
from typing import NamedTuple

import pytest

from robolink.workspace import VARIABLE
from tests.support.commands import ROBOLINK
from tests.support.ros_tree import write_package

PATIENCE = 120.0
pytestmark = pytest.mark.processes

TALKER = """
import rclpy
from rclpy.node import Node
from std_msgs.msg import String

class Talker(Node):
    def __init__(self):
        super().__init__('talker')
        self.heard = []
        self.pub = self.create_publisher(String, 'chatter', 10)
        self.create_subscription(String, 'chatter', lambda msg: self.heard.append(msg.data), 10)
        self.timer = self.create_timer(0.01, self.tick)
        self.count = 0

    def tick(self):
        self.count += 1
        self.pub.publish(String(data=f'hello {self.count}'))
"""


class Style(NamedTuple):
    """A program, how it is run, and what comes of it."""

    text: str
    said: str
    words: tuple[str, ...] = ()
    code: int = 0
    function: str = ""


STYLES = {
    "as the tutorials have it": Style(
        "#!/usr/bin/env python3\n"
        + TALKER
        + """
def main(args=None):
    rclpy.init(args=args)
    node = Talker()
    while rclpy.ok() and node.count < 3:
        rclpy.spin_once(node)
    node.destroy_node()
    rclpy.shutdown()
    print('done')

if __name__ == '__main__':
    main()
""",
        "done\n",
    ),
    "sys.exit(main())": Style(
        TALKER
        + """
import sys

def main():
    rclpy.init()
    node = Talker()
    print(node.get_fully_qualified_name())
    rclpy.shutdown()
    return 3

if __name__ == '__main__':
    sys.exit(main())
""",
        "/talker\n",
        code=3,
    ),
    "a function, for a console script": Style(
        TALKER
        + """
def start(args=None):
    with rclpy.init(args=args):
        print(Talker().get_name())
""",
        "other\n",
        ("--ros-args", "-r", "__node:=other"),
        function="start",
    ),
    "only a class, which spins": Style(
        TALKER + "        if self.count == 2:\n            print('two')\n            rclpy.shutdown()\n",
        "two\n",
    ),
    "no functions at all": Style(
        "import rclpy\nrclpy.init()\nnode = rclpy.create_node('flat')\nprint(node.get_name(), rclpy.ok())\n",
        "flat True\n",
    ),
    "argparse behind remove_ros_args": Style(
        """
import argparse, sys
import rclpy
from rclpy.utilities import remove_ros_args

def main(argv=sys.argv):
    parser = argparse.ArgumentParser()
    parser.add_argument('--rate', type=float, default=1.0)
    parser.add_argument('-v', action='store_true')
    parser.add_argument('what')
    args = parser.parse_args(remove_ros_args(args=argv)[1:])
    rclpy.init(args=argv)
    node = rclpy.create_node('given', automatically_declare_parameters_from_overrides=True)
    print(args.rate, args.v, args.what, node.get_parameter('speed').value, __name__)
    rclpy.try_shutdown()

if __name__ == '__main__':
    main()
""",
        "5.0 True lap 2 __main__\n",
        ("--rate", "5", "-v", "lap", "-p", "speed:=2"),
    ),
    "asyncio around it": Style(
        TALKER
        + """
import asyncio

async def spin(node):
    while node.count < 3:
        rclpy.spin_once(node, timeout_sec=0)
        await asyncio.sleep(0.001)
    return node.count

def main():
    rclpy.init()
    node = Talker()
    print(asyncio.run(spin(node)) >= 3)
    node.destroy_node()
    rclpy.shutdown()

if __name__ == '__main__':
    main()
""",
        "True\n",
    ),
    "spinning in a thread": Style(
        TALKER
        + """
import threading

rclpy.init()
node = Talker()
thread = threading.Thread(target=rclpy.spin, args=(node,), daemon=True)
thread.start()
rate = node.create_rate(100)
while len(node.heard) < 2:
    rate.sleep()
print(node.heard[0])
rclpy.shutdown()
thread.join()
""",
        "hello 1\n",
    ),
    "an executor of its own": Style(
        TALKER
        + """
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor

def main(args=None):
    rclpy.init(args=args)
    try:
        nodes = [Talker(), rclpy.create_node('second')]
        executor = MultiThreadedExecutor(num_threads=2)
        for node in nodes:
            executor.add_node(node)
        nodes[1].create_timer(0.01, lambda: None, callback_group=ReentrantCallbackGroup())
        # in the talker's own group, so that it does not publish meanwhile
        nodes[0].create_timer(0.01, lambda: rclpy.shutdown() if nodes[0].heard else None)
        try:
            executor.spin()
        finally:
            executor.shutdown()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    print(nodes[0].heard[0])

if __name__ == '__main__':
    main()
""",
        "hello 1\n",
    ),
    "files beside it": Style(
        """
from pathlib import Path
import rclpy
from helpers import shout

def main():
    here = Path(__file__).resolve().parent
    print(shout((here / 'data.txt').read_text()), open('data.txt').read())

if __name__ == '__main__':
    main()
""",
        "DATA data\n",
    ),
    "all of its companions": Style(
        """
import rclpy, rclpy.node, rclpy.qos
import tf2_ros, tf2_geometry_msgs, tf_transformations, message_filters
from rclpy.action import ActionServer
from rclpy.qos import QoSProfile, ReliabilityPolicy, qos_profile_sensor_data
from ament_index_python.packages import get_package_share_directory
from geometry_msgs.msg import PoseStamped, Twist
from nav_msgs.msg import Odometry
from rosidl_runtime_py import set_message_fields
from rosidl_runtime_py.utilities import get_message
from sensor_msgs_py import point_cloud2
from std_msgs.msg._string import String
from tf2_ros import TransformException
from tf2_ros.buffer import Buffer
from tf2_ros.transform_listener import TransformListener
print(get_message('std_msgs/msg/String') is String, round(tf_transformations.quaternion_from_euler(0, 0, 3.1)[3], 2))
""",
        "True 0.02\n",
    ),
    "an error of its own": Style(
        "import rclpy\n\ndef main():\n    {}['mine']\n\nif __name__ == '__main__':\n    main()\n", "", code=1
    ),
    "a service called by itself": Style(
        """
import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.node import Node

class Minimal(Node):
    def __init__(self):
        super().__init__('minimal')
        self.srv = self.create_service(AddTwoInts, 'add_two_ints', self.add)
        self.cli = self.create_client(AddTwoInts, 'add_two_ints')
        while not self.cli.wait_for_service(timeout_sec=1.0):
            self.get_logger().info('service not available, waiting again...')

    def add(self, request, response):
        response.sum = request.a + request.b
        return response

    def send(self, a, b):
        self.future = self.cli.call_async(AddTwoInts.Request(a=a, b=b))
        rclpy.spin_until_future_complete(self, self.future)
        return self.future.result()

def main():
    rclpy.init()
    minimal = Minimal()
    print(minimal.send(2, 3).sum)
    minimal.destroy_node()
    rclpy.shutdown()

if __name__ == '__main__':
    main()
""",
        "5\n",
    ),
}


def run(folder: Path, *words: str) -> tuple[int, str, str]:
    """Run `robolink run WORDS` in a folder, in memory."""
    environ = {name: value for name, value in os.environ.items() if name not in (VARIABLE, "ROBOLINK_COMPAT")}
    done = subprocess.run(
        [*ROBOLINK, "run", *words],
        cwd=folder,
        env={**environ, "ROBOLINK_TRANSPORT": "memory://alone"},
        capture_output=True,
        text=True,
        timeout=PATIENCE,
        check=False,
    )
    return done.returncode, done.stdout, done.stderr


@pytest.fixture(scope="module")
def outcomes(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Future[tuple[int, str, str]]]:
    """Each program in a folder of its own, run a few at a time."""
    pool = ThreadPoolExecutor(os.cpu_count() or 1)
    started = {}
    for number, (name, style) in enumerate(STYLES.items()):
        folder = tmp_path_factory.mktemp(f"program_{number}")
        (folder / "program.py").write_text(style.text)
        (folder / "data.txt").write_text("data")
        (folder / "helpers.py").write_text("shout = str.upper\n")
        file = f"program.py:{style.function}" if style.function else "program.py"
        started[name] = pool.submit(run, folder, file, *style.words)
    pool.shutdown(wait=False)
    return started


@pytest.mark.parametrize("name", STYLES)
def test_a_program_runs_unchanged(name: str, outcomes: dict[str, Future[tuple[int, str, str]]]) -> None:
    style = STYLES[name]
    code, out, err = outcomes[name].result()
    assert (code, out) == (style.code, style.said), err
    if name == "an error of its own":
        first, place, *_, last = err.splitlines()
        assert (first, last) == ("Traceback (most recent call last):", "KeyError: 'mine'")
        assert "program.py" in place
    else:
        assert err == ""


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no signals to send")
def test_ctrl_c_ends_a_spinning_program_without_a_word(tmp_path: Path) -> None:
    program = tmp_path / "spin.py"
    program.write_text(
        TALKER + "        if self.count == 2:\n            print('up', flush=True)\n\n"
        "rclpy.init()\nnode = Talker()\ntry:\n    rclpy.spin(node)\n"
        "except KeyboardInterrupt:\n    pass\nfinally:\n    node.destroy_node()\n    rclpy.try_shutdown()\n"
    )
    environ = {**os.environ, "ROBOLINK_TRANSPORT": "memory://alone"}
    command = [*ROBOLINK, "run", str(program)]
    pipe = subprocess.PIPE
    with subprocess.Popen(command, env=environ, stdout=pipe, stderr=pipe, text=True) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "up\n"
        process.send_signal(signal.SIGINT)
        assert process.communicate(timeout=PATIENCE) == ("", "")
        assert process.returncode == 0


NODE = '''"""The first node."""
import rclpy
from ament_index_python.packages import get_package_share_directory
from meu_robo_py.helpers import OLA
from rclpy.node import Node


class PrimeiroNode(Node):
    def __init__(self):
        super().__init__('primeiro_node')
        print(OLA, self.get_name(), open(get_package_share_directory('meu_robo_py') + '/config/a.txt').read())


def main(args=None):
    rclpy.init(args=args)
    PrimeiroNode().destroy_node()
    rclpy.shutdown()
'''


def test_the_lines_of_a_course_work_without_a_build(tmp_path: Path) -> None:
    """A tree as `ros2 pkg create` makes it, and `ros2 run PACKAGE EXECUTABLE` with robolink in ros2's place."""
    workspace = tmp_path / "ros2_ws"
    files = {"primeiro_node.py": NODE, "helpers.py": "OLA = 'Olá'\n"}
    package = write_package(workspace / "src", "meu_robo_py", files, "primeiro_node = meu_robo_py.primeiro_node:main")
    (package / "config").mkdir()
    (package / "config/a.txt").write_text("um")
    words = ("meu_robo_py", "primeiro_node", "--ros-args", "-r", "__node:=outro")
    with ThreadPoolExecutor() as pool:
        ran = pool.submit(run, workspace, *words)
        elsewhere = pool.submit(run, tmp_path, "--workspace", str(workspace), *words)
        listed = pool.submit(run, workspace, "--list")
    assert ran.result() == elsewhere.result() == (0, "Olá outro um\n", "")
    rows = [line.split() for line in listed.result()[1].splitlines()]
    assert ["meu_robo_py", "primeiro_node", "The", "first", "node."] in rows
