"""Usual mistakes of beginners: what a program's error says beyond Python's own text, as `robolink run` shows it."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from robolink.testing import System
from robolink.testing.expectations import NodeFailure
from robolink.text.advice import home_of
from robolink.text.callbacks import place_of
from robolink.text.tracebacks import formatted

HEAD = """from robolink import Node
from robolink.interfaces.geometry_msgs.msg import Twist
from robolink.interfaces.std_srvs.srv import SetBool


class Careful(Node):
    def __init__(self):
        super().__init__("careful")
        self.cmd_vel = self.create_publisher(Twist, "cmd_vel", 10)
"""
TIMER = "        self.create_timer(0.1, self.on_timer)\n\n    def on_timer(self):\n"
SERVICE = (
    '        self.create_service(SetBool, "go", self.on_go)\n'
    '        self.create_client(SetBool, "go").call_async(SetBool.Request())\n\n'
)

MISTAKES = [
    (
        "        self.create_timer(0.1, self.on_timer)\n\ndef on_timer(self):\n    pass",
        "on_timer of line 12 stands outside",
    ),
    (
        "        self.create_timer(0.1, self.on_timer)\n\n    def on_timer():\n        pass",
        "`def on_timer(self):` (m.py:12)",
    ),
    ("        self.create_timer(1,0, self.creat)", "Did you mean: 'create_"),
    ("        self.create_timer(1,0, self.get_name)", "got 0 (a decimal number has a point: 1.0)"),
    ("        create_timer(0.1, self.get_name)", "did you mean self.create_timer?"),
    ("        self.create_timer(0.1, self.get_name())", "must be callable, got 'careful'"),
    (TIMER + "        twist = Twist\n        twist.linear.x = 0.3", "this is the class, not a message"),
    (TIMER + "        self.cmd_vel.publish(Twist)", "a message is made with (): Twist()"),
    (TIMER + "        self.cmd_vel(Twist())", "its method publish(message) sends a message"),
    (TIMER + "        Twist().x = 0.3", "has no attribute 'x'"),
    (
        TIMER + "        twist = Twist()\n        twist.x = 0.3",
        "'Twist' object has no attribute 'x' (only linear, angular)",
    ),
    (TIMER + "        self.cmd_vel.publish(Twist(linear=(0, 3)))", "expected geometry_msgs/msg/Vector3, got (0, 3)"),
    (
        TIMER + "        twist = Twist()\n        twist.linear.x = 0,3\n        self.cmd_vel.publish(twist)",
        "Twist.linear.x: expected float64, got (0, 3); a decimal number has a point: 0.3",
    ),
    (TIMER + "        cmd_vel.publish(Twist())", "did you mean self.cmd_vel?"),
    ("        self.count = 0\n" + TIMER + "        count += 1", "did you mean self.count?"),
    (
        "        self.create_subscription(LaserScan, 'scan', self.on_scan, 10)",
        "is `from robolink.interfaces.sensor_msgs.msg import LaserScan` missing on top?",
    ),
    (
        "        self.create_subscription(Twist, 'x', self.on_x, 10)\n\n    def on_x(self):\n        pass",
        "on_x takes neither one argument nor two: write `def on_x(self, message):` (m.py:12)",
    ),
    (SERVICE + "    def on_go(self, request):\n        pass", "write `def on_go(self, request, response):` (m.py:13)"),
    (
        SERVICE + "    def on_go(self, request, response):\n        pass",
        "got None: is `return response` missing at the end of on_go (m.py:13)?",
    ),
    ("        self.get_logger.info('x')", "get_logger is a function: call it, get_logger()"),
    ("        self.logger().info('x')", "Did you mean: 'get_logger'?"),
    ("        self.declare_parameter('near', 0.5) < 3", "its value is what .value has"),
    ("        import math\n        globals()['math'] = math\n        pi", "did you mean math.pi?"),
    ("        math.pi", "is `import math` missing on top?"),
    ("\n    self.cmd_vel.publish(Twist())", "this line is in no function"),
    ("        self.go(3)\n\n    def go(speed):\n        pass", "the first parameter of go (line 12) has to be self"),
    ("        self.go()\n\n    def go(speed):\n        self.x = 3", "is self the first parameter of go()?"),
    ("        self.create_publisher(Twist, 'x')", "is how many messages may wait, such as 10"),
]


def failure(program: str, folder: Path, system: System) -> BaseException:
    """Return what a program raises."""
    (folder / "m.py").write_text(program, encoding="utf-8")
    with pytest.raises(Exception) as caught:  # noqa: PT011, PT012 - whatever Python says
        system.start(str(folder / "m.py"))
        system.run(1.0)
    error = caught.value
    return error.__cause__ if isinstance(error, NodeFailure) and error.__cause__ is not None else error


@pytest.mark.slow
@pytest.mark.parametrize(("body", "advice"), MISTAKES, ids=[each[1][:40] for each in MISTAKES])
def test_a_usual_mistake_is_told_with_what_to_do(body: str, advice: str, tmp_path: Path, system: System) -> None:
    last = formatted(failure(f"{HEAD}{body}\n", tmp_path, system)).splitlines()[-1]
    assert advice in last
    assert last.count("id you mean") <= 1
    assert "'_" not in last


@pytest.mark.parametrize(
    ("program", "advice"),
    [
        ("from robolink import Node, Twist", "geometry_msgs.msg import Twist`"),
        (
            "from robolink.interfaces.geometry_msgs.msg import Odometry",
            "nav_msgs.msg",
        ),
        ("from geometry_msgs.msg import Odometry", "it is in nav_msgs.msg"),
        (
            "from robolink import node\nclass A(node):\n    pass",
            "node is a module, and Node the class: `from robolink import Node`",
        ),
        ("import rclpy\nclass A(Node):\n    pass", "is `from rclpy.node import Node` missing on top?"),
        ("import rclpy\nprint(Twist)", "is `from geometry_msgs.msg import Twist` missing on top?"),
        (
            "from robolink import Node\nclass A(Node):\n    def __init__(self):\n        super.__init__('a')",
            "() after super",
        ),
        (
            "from robolink import Node\nclass A(Node):\n    def __init__(self):\n        super().__init__()",
            "needs a name",
        ),
    ],
)
def test_a_mistake_before_there_is_a_node(program: str, advice: str, tmp_path: Path, system: System) -> None:
    assert advice in formatted(failure(program, tmp_path, system)).splitlines()[-1]


def test_the_place_is_that_of_the_callback_which_no_line_of_the_traceback_has(tmp_path: Path, system: System) -> None:
    body = "        self.create_timer(0.1, self.on_timer)\n\n    def on_timer():\n        pass\n"
    place = place_of(failure(HEAD + body, tmp_path, system))
    assert place == (str(tmp_path / "m.py"), 12)
    text = formatted(failure(HEAD + body, tmp_path, system)).splitlines()
    assert text[:2] == [f'  File "{tmp_path / "m.py"}", line 12', "    def on_timer():"]
    assert len(text) == 3, "no line of robolink's own"
    answered = SERVICE.replace("self.create_service", "self.s = self.create_service") + (
        "    def on_go(self, request, response):\n        self.s.send_response(3, None)\n"
    )
    assert place_of(failure(HEAD + answered, tmp_path, system)) is None, "its own line is in the traceback"
    within = failure(HEAD + TIMER + "        self.get_name(3)\n", tmp_path, system)
    assert place_of(within) is None


def test_a_search_for_an_attribute_is_no_part_of_the_traceback(tmp_path: Path, system: System) -> None:
    text = formatted(failure(HEAD + "        self.creat_timer(0.1, self.get_name)\n", tmp_path, system))
    assert "__getattr__" not in text
    assert text.endswith("has no attribute 'creat_timer'. Did you mean: 'create_timer'?")


def test_names_that_are_in_no_module_have_no_home() -> None:
    assert home_of("Twist", "robolink.x") == "from robolink.interfaces.geometry_msgs.msg import Twist"
    assert home_of("Twist", "rclpy") == "from geometry_msgs.msg import Twist"
    assert home_of("SetBool", "rclpy") == "from std_srvs.srv import SetBool"
    assert home_of("Twits", "rclpy") == ""
    assert (home_of("math") == "import math") is ("math" in sys.stdlib_module_names)
