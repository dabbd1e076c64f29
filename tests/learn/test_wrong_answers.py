"""Wrong answers that beginners give: each is told in a sentence that says what is wrong."""

from __future__ import annotations

from pathlib import Path

import pytest

from robolink.learn.checking import check
from robolink.learn.exercise import chosen, read_course
from robolink.learn.lines import reported

SOLUTIONS = Path(__file__).parent / "solutions"
COURSE = read_course()

TWICE = """    executor = SingleThreadedExecutor()
    executor.add_node(Talker())
    executor.add_node(Listener())
    executor.spin()"""

WRONG = [
    ("walk", "def square(", "def quadrado(", "lacks something that the exercise asks for: 01_walk.py has no attribute"),
    ("walk", "def __init__(self)", "def __init__(self, name)", "missing 1 required positional argument: 'name'"),
    ("walk", "270)", "0)", "it ends 2.12 m from where it began"),
    ("hello", 'get_logger().info("hello")', "get_logger()", "it says nothing"),
    ("hello", "spin(node)", "spin(FirstNode)", "expected a Node to spin"),
    ("hello", "    rclpy.init()\n", "", "rclpy.init() has not been called"),
    ("hello", '"first_node"', '"FirstNode"', "its name is FirstNode, and not first_node"),
    ("hello", "        self.get_logger", "      self.get_logger", "IndentationError"),
    ("timer", "self.tick)", "self.tick())", "give it the function itself, without ()"),
    ("timer", "self.count = 0", "self.count = 1", 'should have "count 1", and has count 2'),
    ("publisher", '"cmd_vel"', '"cmdvel"', "the node has a publisher for: cmdvel"),
    ("publisher", "linear.x", "linear.y", "linear.x is 0.00, and should be 0.30"),
    ("publisher", "= 0.3", '= "0.3"', "Twist.linear.x: expected float64, got '0.3'"),
    ("ramp", "> 1.0", "> 2.0", "after 1.0 it should begin again with 0.0, and said 1.1"),
    ("square", "math.pi / 4", "45", "it ends "),
    ("subscriber", "if r > 0", "if r >= 0", "with a beam of 0 among 1.5 and 2.5 it said 0.00"),
    ("stop", "scan.ranges[middle - 30 : middle + 30]", "scan.ranges", "it drove 0.0 m in three seconds"),
    ("react", "< 1.0", "< 0.1", "it ran into something after "),
    ("odometry", "< 2.0", "< 1.0", "it drove 1.0"),
    ("talk", TWICE, "    rclpy.spin(Talker())\n    rclpy.spin(Listener())", "there is no node called listener"),
    ("service", "        response.success = True\n", "", "success of the answer is False"),
    ("client", "request.b = 3", "request.b = 4", "it asked for 2 + 4, and not for 2 + 3"),
    ("parameter", "    rclpy.spin(Driver())", "    Driver()", "it has come to its end: is there an rclpy.spin?"),
    ("limits", "        return SetParametersResult(successful=True)\n", "", "on_set returned something else"),
    ("launch", "- node: world\n    parameters: {world: obstacles}\n  ", "", "there is no robot"),
    ("two_robots", "namespace: bob", "namespace: bib", "bob stands"),
    ("pid", "ki = 1.5", "ki = 20.0", "less ki or more kp keeps it below 1.3"),
    ("frames", "0.2\n", "2.0\n", "it is 2.00 m ahead, and not 0.20"),
    ("action", "numbers[-1] + numbers[-2]", "numbers[-1] + 1", "the result is 0, 1, 2, 3, 4, 5"),
    ("bag", "last = place", "pass", "driven() returned 0.00"),
    ("testing", "== 0.3", "== 0.0", 'fails with the good program: assert system.expect("cmd_vel").linear.x == 0.0'),
    ("camera", "        if len(columns) == 0:\n            return\n", "", "there was no yellow, and it said nan"),
    ("safe", "> 0.5e9", "> 5e9", "no scan came for two seconds, and it still drives with 0.3 m/s"),
    ("states", ">= 1.5", ">= 0.1", "BACK took 1.0 s and TURN 0.1 s, and should take 1.0 and 1.5"),
    ("follow_wall", "-2.0 * (right", "2.0 * (right", "and ran into something"),
]


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::RuntimeWarning")
@pytest.mark.parametrize(("name", "right", "wrong", "told"), WRONG, ids=[f"{a}-{d[:24]}" for a, _, _, d in WRONG])
def test_a_wrong_answer_is_told(name: str, right: str, wrong: str, told: str, tmp_path: Path) -> None:
    exercise = chosen(COURSE, name)
    text = (SOLUTIONS / exercise.file).read_text(encoding="utf-8")
    assert right in text
    file = tmp_path / exercise.file
    file.write_text(text.replace(right, wrong), encoding="utf-8")
    report = check(exercise, file)
    assert not report.passed
    lines = " ".join(" ".join(reported(exercise, report, "en")).split())
    assert told in lines
    assert "Traceback" not in lines
