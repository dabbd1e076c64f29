"""Wrong answers that beginners give: each is told in a sentence that says what is wrong."""

from __future__ import annotations

from pathlib import Path

import pytest

from robolink.learn.checking import check
from robolink.learn.exercise import Exercise, chosen, read_course
from robolink.learn.lines import reported

SOLUTIONS = Path(__file__).parent / "solutions"
COURSE = read_course()

TWICE = """    executor = SingleThreadedExecutor()
    executor.add_node(Talker())
    executor.add_node(Listener())
    executor.spin()"""

SLEEPS = "import time\n    while True:\n        time.sleep(1.0)"
LOOP = "import time\n        while True:\n            time.sleep(1.0)\n            self.tick()"
TENTH = "0.1, self.drive)\n\n    def drive"
AT_ONCE = "1.0, self.ten)\n\n    def ten(self):\n        for _ in range(10):\n            self.drive()\n\n    def drive"
"""Ten messages each second, all at once."""

WRONG = [
    (
        "walk",
        "def square(",
        "def quadrado(",
        "square is missing in 01_walk.py: the exercise asks for something by this name",
    ),
    ("walk", "def __init__(self)", "def __init__(self, name)", "missing 1 required positional argument: 'name'"),
    ("walk", "270)", "0)", "it ends 2.12 m from where it began"),
    ("hello", 'get_logger().info("hello")', "get_logger()", "it says nothing"),
    ("hello", 'self.get_logger().info("hello")', 'print("hello")', "print writes none"),
    ("hello", "spin(node)", "spin(FirstNode)", "expected a Node to spin"),
    ("hello", "spin(node)", "spin_once(node)", "it ended by itself within six seconds"),
    ("hello", "rclpy.spin(node)", SLEEPS, "it stays, but answers nobody"),
    ("hello", "    rclpy.init()\n", "", "rclpy.init() has not been called"),
    ("hello", '"first_node"', '"FirstNode"', "its name is FirstNode, and not first_node"),
    ("hello", "        self.get_logger", "      self.get_logger", "IndentationError"),
    ("timer", "self.tick)", "self.tick())", "give it the function itself, without ()"),
    ("timer", "def tick(self)", "def tick()", "at line 11: 11 | def tick(): TypeError: Counter.tick() takes 0"),
    ("timer", "1.0, self.tick", "1,0, self.tick", "a decimal number has a point: 1.0"),
    ("timer", "self.get_logger().info(", "print(", "the log is empty (print does not write into it)"),
    ("timer", "self.timer = self.create_timer(1.0, self.tick)", LOOP, "let a timer call tick, in place of a loop"),
    ("timer", "self.count = 0", "self.count = 1", 'should have "count 1", and has count 2'),
    ("publisher", '"cmd_vel"', '"cmdvel"', "the node has a publisher for: cmdvel"),
    ("publisher", "        self.publisher.publish(twist)\n", "", "is publish called, and often enough?"),
    ("publisher", TENTH, AT_ONCE, "10 messages come at once, and should come one by one"),
    ("publisher", "linear.x", "linear.y", "linear.x is 0.00, and should be 0.30"),
    ("publisher", "= 0.3", '= "0.3"', "Twist.linear.x: expected float64, got '0.3'"),
    ("ramp", "> 1.0", "> 2.0", "after 1.0 it should begin again with 0.0, and said 1.1"),
    ("ramp", "> 1.0", "== 1.0", "its 1.0 is 0.9999999999999999, since computers round 0.1"),
    ("square", "math.pi / 4", "45", "it ends "),
    ("subscriber", "if r > 0", "if r >= 0", "with a beam of 0 among 1.5 and 2.5 it said 0.00"),
    ("stop", "scan.ranges[middle - 30 : middle + 30]", "scan.ranges", "it drove 0.0 m in three seconds"),
    ("react", "< 1.0", "< 0.5", "something is 0.8 m ahead, and it drives on with 0.30 m/s"),
    ("react", "z = 0.5\n        else:\n            twist", "z = 0.5\n        twist", "it drives on with 0.30 m/s"),
    ("react", "angular.z = 0.5", "angular.x = 0.5", "something is 0.8 m ahead, and angular.z is 0.00, not 0.50"),
    ("react", "angular.z = 0.5", "angular.z = -0.5", "angular.z is -0.50, not 0.50"),
    ("odometry", "0.4", "0.3", "it drives with 0.30 m/s, and not 0.40"),
    ("odometry", "self.begin = x", "self.begin = 0.0", "at the beginning odom said x = 3.0"),
    ("odometry", "< 2.0", "< 1.0", "it drove 1.0"),
    ("talk", TWICE, "    rclpy.spin(Talker())\n    rclpy.spin(Listener())", "there is no node called listener"),
    ("talk", "create_timer(1.0", "create_timer(0.5", "messages on chatter in three seconds: 6, and should be 3"),
    ("talk", "self.count = 0", "self.count = -1", "it said hello 0, hello 1, hello 2, and not hello 1"),
    ("talk", 'f"heard {', 'f"ouvi {', 'the listener logs "ouvi hello 4", and not "heard hello 2"'),
    ("talk", "self.get_logger().info", "print", "the log has no line of the listener"),
    ("service", "        response.success = True\n", "", "success of the answer to True is False"),
    ("service", "success = True", "success = request.data", "success of the answer to False is False"),
    ("service", '"power"', '"poder"', "there is no service power; there is: poder"),
    ("service", "SetBool", "Trigger", "power is of the type std_srvs/srv/Trigger, and not SetBool"),
    ("service", "create_timer(0.1", "create_timer(9.0", "nothing came on cmd_vel in a second"),
    (
        "service",
        "        self.is_on = request.data",
        "        import time; time.sleep(9)",
        "your program sleeps at line ",
    ),
    ("service", "return response", "return True", "must return a SetBool.Response, got True"),
    ("client", "request.b = 3", "request.b = 4", "it asked for 2 + 4, and not for 2 + 3"),
    ("client", 'f"sum is {future.result().sum}"', '"sum is"', 'the log has no line with "sum is 5"'),
    (
        "client",
        "        future.add_done",
        '        self.get_logger().info("sum is 5")\n        future.add_done',
        "before the answer",
    ),
    ("parameter", "create_timer(0.1", "create_timer(1.0", "messages on cmd_vel in a second: 1, and should be 10"),
    ("parameter", "create_timer(0.1", "create_timer(10.0", "nothing came on cmd_vel in a second"),
    (
        "parameter",
        "        self.timer",
        "        self.add_on_set_parameters_callback(lambda changes: None)\n        self.timer",
        "a callback for changes has to return SetParametersResult(successful=True)",
    ),
    ("parameter", "    rclpy.spin(Driver())", "    Driver()", "it has come to its end: is there an rclpy.spin?"),
    ("limits", "        return SetParametersResult(successful=True)\n", "", "on_set returned something else"),
    ("limits", "0.0 <= each.value <= 1.0", "0.0 <= each.value < 1.0", "it refused 1.0, which is fine"),
    ("limits", "0.0 <= each.value <= 1.0", "0.0 < each.value <= 1.0", "it refused 0.0, which is fine"),
    ("launch", "world: obstacles", "world: empty_room", "the world is empty_room, and not obstacles"),
    ("launch", "- node: world\n    parameters: {world: obstacles}\n  ", "", "there is no robot"),
    ("two_robots", "namespace: bob", "namespace: bib", "bob needs a node bob/reactive_controller; there is: ada/"),
    ("two_robots", "reactive_controller", "wall_follower", "there is: ada/wall_follower, bob/wall_follower"),
    ("two_robots", "nodes:\n", "nodes:\n  - node: world\n    name: other\n", "there are two worlds now"),
    (
        "pid",
        "Float64",
        "Float32",
        "one topic has two types, and nothing gets from one to the other: /speed: std_msgs/msg/",
    ),
    ("pid", "ki = 1.5", "ki = 20.0", "less ki or more kp keeps it below 1.3"),
    ("frames", "0.2\n", "2.0\n", "it is 2.00 m ahead, and not 0.20"),
    ("frames", "translation.z", "translation.y", "it is 0.30 m to the left (y), and should be in the middle"),
    ("frames", "rotation.w = 1.0", "rotation.w = 0.0", "it is turned: its rotation is 0.0, 0.0, 0.0, 0.0"),
    ("frames", "StaticTransformBroadcaster", "TransformBroadcaster", "it publishes on /tf, which is for what moves"),
    ("where", "Float32", "Float64", "distance is of the type std_msgs/msg/Float64, and not Float32"),
    (
        "where",
        "create_timer(0.5",
        "create_timer(0.1",
        "messages on distance in a second and a half: 15, and should be 3",
    ),
    ("where", '"goal", Time()', '"gaol", Time()', "tf knows both frames, and nothing came on distance"),
    ("action", "            feedback.sequence = numbers\n", "", "should have the numbers 0, 1, 1, and has: -"),
    ("action", "        return result\n", "", "no numbers came back"),
    ("action", "            goal_handle.publish_feedback(feedback)\n", "", "times it came: 0"),
    ("action", "numbers[-1] + numbers[-2]", "numbers[-1] + 1", "the result is 0, 1, 2, 3, 4, 5"),
    ("bag", "last = place", "pass", "driven() returned 0.00"),
    ("bag", "    return metres", "    return 1.94", "where it drove a circle of 1.20 m, driven() returned 1.94"),
    ("testing", "def test_", "def testa_", "there is no function whose name begins with test_"),
    ("testing", "== 0.3", "== 0.0", 'fails with the good program: assert system.expect("cmd_vel").linear.x == 0.0'),
    ("camera", "        if len(columns) == 0:\n            return\n", "", "there was no yellow, and it said nan"),
    ("safe", "> 0.5e9", "> 5e9", "no scan came for two seconds, and it still drives with 0.3 m/s"),
    ("states", ">= 1.5", ">= 0.1", "BACK took 1.0 s and TURN 0.1 s, and should take 1.0 and 1.5"),
    ("states", "angular.z = 0.8", "angular.z = -0.8", "in TURN linear.x is 0.0 and angular.z -0.8, and should be 0.0"),
    ("states", "linear.x = -0.2", "linear.x = 0.2", "in BACK linear.x is 0.2 and angular.z 0.0, and should be -0.2"),
    ("states", "data=state))", "data=state)); import time; time.sleep(1.0)", "in BACK too few commands came: 0"),
    (
        "states",
        "        twist = Twist()",
        "        self.change(self.state); twist = Twist()",
        "published twice in a row",
    ),
    ("safe", '"cmd_vel"', '"cmdvel"', "scans came, and nothing was published on cmd_vel"),
    ("follow_wall", "-2.0 * (right", "2.0 * (right", "and ran into something"),
    (
        "follow_wall",
        "angular.z = 0.5",
        "angular.z = 30.0",
        "standing, it asked for a turn of 30.0 rad/s, and not of 0.5",
    ),
    ("follow_wall", "linear.x = 0.3", "linear.x = 1.0", "it asked for 1.0 m/s, and not for 0.3"),
    (
        "particles",
        "random.gauss(metres, 0.05)",
        "metres",
        "spread by 0.05 m as they drive, and spread by 0.000 m",
    ),
    ("particles", "x + random", "random", "and are at 0.50 m on average, not at 2.50"),
    ("particles", "beside == sees_door", "beside", "a particle beside a door weighs 0.90, and one beside a wall 0.10"),
    ("particles", "else 0.1", "else 0.0", "a weight is 0.00: after one wrong look the right guess would be gone"),
    ("particles", "k=len(particles)", "k=1", "there were 1000 particles, and after resample there are: 1"),
    ("particles", "particles, weights, k", "particles, k", "75 % of the particles, and has 48 %"),
    ("particles", "return weights", "return None", "has no len()"),
    (
        "estimate",
        "        if self.publisher.get_subscription_count() == 0:\n            return\n",
        "",
        "and nothing came",
    ),
    ("estimate", "        self.timer.cancel()\n", "", "it came 7 times"),
    ("estimate", "math.sin(math.pi / 4)", "math.pi / 2", "its orientation has the length 1.72, and not 1"),
    ("estimate", "math.pi / 4", "math.pi / 2", "it looks to 180 degrees, and not to 90"),
    ("estimate", "covariance[35]", "covariance[5]", "are 0.25, 0.25 and 0.00, and not 0.25, 0.25 and 0.07"),
    ("tour", '"map"', '"odom"', "its frame is 'odom', and not 'map'"),
    ("tour", "reached += 1", "reached += 1\n        else:\n            break", "and then came: -"),
    ("tour", "        if navigator.getResult() == TaskResult.SUCCEEDED:\n    ", "", "and has: reached 3 of 3"),
    ("tour", "(5.0, 3.0), (1.0, 4.0)", "(1.0, 4.0), (5.0, 3.0)", "the next goal was (1.0, 4.0), and not (5.0, 3.0)"),
    ("tour", "PLACES:", "PLACES[:0]:", "no goal came on the action navigate_to_pose"),
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


TWO_TESTS = """
from robolink.interfaces.sensor_msgs.msg import LaserScan

def test_it_drives(system, program):
    system.start(program)
    system.publish("scan", LaserScan(ranges=[3.0]))
    assert system.expect("cmd_vel").linear.x == 0.3

def test_it_stops(system, program):
    system.start(program)
    system.publish("scan", LaserScan(ranges=[0.2]))
    assert system.expect("cmd_vel").linear.x == 0.0
"""

OTHER = [
    ("testing", "", TWO_TESTS),
    ("states", '        self.state = "DRIVE"\n        self.since', '        self.change("DRIVE")\n        self.since'),
    ("talk", "executor.spin()", "while rclpy.ok():\n        executor.spin_once()"),
    ("service", "return response", "return SetBool.Response(success=True)"),
    ("launch", "    parameters: {world: obstacles}\n", ""),
    ("two_robots", "namespace: ada", "namespace: /ada"),
    ("where", "except TransformException", "except Exception"),
]


@pytest.mark.slow
@pytest.mark.parametrize(("name", "old", "new"), OTHER, ids=[f"{a}-{c[:24].strip()}" for a, _, c in OTHER])
def test_another_right_answer_passes(name: str, old: str, new: str, tmp_path: Path) -> None:
    exercise = chosen(COURSE, name)
    text = (SOLUTIONS / exercise.file).read_text(encoding="utf-8")
    assert old in text
    file = tmp_path / exercise.file
    file.write_text(text.replace(old, new) if old else new, encoding="utf-8")
    report = check(exercise, file)
    assert [each.text for each in report.lines if not each.good] == []
    assert report.passed


@pytest.mark.parametrize("exercise", COURSE, ids=[each.name for each in COURSE])
def test_a_file_of_comments_alone_is_called_empty(exercise: Exercise, tmp_path: Path) -> None:
    file = tmp_path / exercise.file
    for text in ("", "# a comment\n\n"):
        file.write_text(text, encoding="utf-8")
        lines = list(reported(exercise, check(exercise, file), "pt"))
        assert lines[0] == f"  ✗ {exercise.file} está vazio, ou só tem comentários"
