"""Programs for Webots drive a robot of the simulated world: devices, steps, names, and worlds that come late."""

from __future__ import annotations

import itertools
import math
import os
import re
from pathlib import Path
from typing import Any

import pytest

from robolink.compat.maker import room_of
from robolink.exceptions import NotFoundError
from robolink.interfaces.geometry_msgs.msg import Twist, Vector3
from robolink.interfaces.sensor_msgs.msg import JointState
from robolink.interfaces.std_msgs.msg import Header
from robolink.testing import System
from robolink.webots_controller.robot import StepError
from robolink.webots_controller.webots_controller import WebotsController, robot_name
from tests.support.nodefiles import load_node_file
from tests.support.systems import log, made_with

simulation = load_node_file("world")

WORLD = """#VRML_SIM R2023b utf8
WorldInfo { title "lab" basicTimeStep 20 }
RectangleArena { floorSize 20 20 wallHeight 1 }
Robot {
  name "cart"
  translation 0 0 0.1
  children [
    Shape { geometry Box { size 0.4 0.3 0.2 } }
    HingeJoint {
      jointParameters HingeJointParameters { axis 0 1 0 }
      device [ RotationalMotor { name "left wheel motor" maxVelocity 20 } PositionSensor { name "left wheel sensor" } ]
      endPoint Solid { translation 0 0.16 0 rotation 1 0 0 1.5707963
        children [ DEF TYRE Shape { geometry Cylinder { radius 0.1 height 0.02 } } ] }
    }
    HingeJoint {
      jointParameters HingeJointParameters { axis 0 1 0 }
      device [ RotationalMotor { name "right wheel motor" maxVelocity 20 } PositionSensor { name "right sensor" } ]
      endPoint Solid { translation 0 -0.16 0 rotation 1 0 0 1.5707963 children [ USE TYRE ] }
    }
    Lidar { name "LDS-01" fieldOfView 3.141592653589793 horizontalResolution 181 maxRange 15 minRange 0.1 }
    DistanceSensor { name "ds 0" rotation 0 0 1 1.5707963 lookupTable [ 0 0 0, 12 12 0 ] }
    TouchSensor { name "bumper" }
    Gyro { }
    Accelerometer { }
    InertialUnit { }
  ]
}
"""
LEFT, RIGHT = "left wheel motor", "right wheel motor"


class Driver(WebotsController):
    """Turns its two motors as cmd_vel says: linear.x and angular.z are rad/s."""

    def __init__(self, left: str = LEFT, right: str = RIGHT, **options: Any) -> None:
        super().__init__("driver", **options)
        self.create_subscription(Twist, "cmd_vel", self.on_cmd_vel, 10)
        self.left, self.right = self.robot.getDevice(left), self.robot.getDevice(right)
        for motor in (self.left, self.right):
            motor.setPosition(float("inf"))
            motor.setVelocity(0.0)

    def on_cmd_vel(self, twist: Twist) -> None:
        self.left.setVelocity(twist.linear.x - twist.angular.z)
        self.right.setVelocity(twist.linear.x + twist.angular.z)


@pytest.fixture
def world(tmp_path: Path) -> str:
    path = tmp_path / "lab.wbt"
    path.write_text(WORLD)
    return str(path)


def command(system: System, x: float, z: float = 0.0) -> None:
    publisher = system.node.create_publisher(Twist, "/cmd_vel", 10)
    publisher.publish(Twist(linear=Vector3(x=x), angular=Vector3(z=z)))


def test_motors_drive_the_robot(system: System, world: str) -> None:
    odometry = system.messages("/odom")
    system.start(simulation.SimulatedWorld, parameters={"world": world})
    system.start(Driver)
    system.run(1.0)
    assert odometry[-1].twist.twist.linear.x == 0.0
    command(system, 3.0)
    system.run(3.0)
    assert odometry[-1].twist.twist.linear.x == pytest.approx(0.3)
    command(system, 0.0, 0.8)
    system.run(3.0)
    assert odometry[-1].twist.twist.linear.x == pytest.approx(0.0, abs=1e-9)
    assert odometry[-1].twist.twist.angular.z == pytest.approx(0.5)


def test_cmd_vel_is_for_the_program_alone(system: System, world: str) -> None:
    odometry = system.messages("/odom")
    system.start(simulation.SimulatedWorld, parameters={"world": world})
    driver = system.start(Driver)
    system.run(0.5)
    for _ in range(20):  # 0.5 rad/s are 0.05 m/s; the world itself would go at 0.5 m/s
        command(system, 0.5)
        system.run(0.1)
    assert max(each.twist.twist.linear.x for each in odometry) == pytest.approx(0.05)
    driver.destroy_node()
    system.run(1.0)
    assert odometry[-1].twist.twist.linear.x == 0.0  # whoever leaves stops the motors
    command(system, 0.5)
    system.run(0.4)
    assert odometry[-1].twist.twist.linear.x > 0.3


def test_the_world_may_come_later_and_begin_anew(system: System, world: str) -> None:
    odometry = system.messages("/odom")
    driver = system.start(Driver)
    driver.left.setVelocity(2)
    driver.right.setVelocity(2)
    system.run(6.0)
    assert "nothing is heard on /joint_states: is 'robolink run world -p world:=FILE.wbt' running?" in log(system)
    first = system.start(simulation.SimulatedWorld, parameters={"world": world})
    system.run(1.0)
    assert odometry[-1].twist.twist.linear.x == pytest.approx(0.2)
    first.destroy_node()
    system.start(simulation.SimulatedWorld, parameters={"world": world})
    system.run(1.0)
    assert odometry[-1].twist.twist.linear.x == pytest.approx(0.2)


def test_both_motors_are_told_at_once_and_only_what_is_new(system: System) -> None:
    commands, joints = (
        system.messages("/joint_command"),
        system.node.create_publisher(JointState, "/joint_states", 10),
    )
    driver = system.start(Driver)

    def tell(milliseconds: int) -> None:
        stamp = system.node.get_clock().now().to_msg()
        stamp.sec, stamp.nanosec = 5, milliseconds * 1_000_000
        joints.publish(
            JointState(header=Header(stamp=stamp), name=[LEFT, RIGHT], position=[0.0, 0.0], velocity=[0.0, 0.0])
        )
        system.run(0.01)

    tell(0)
    driver.left.setVelocity(1)
    driver.right.setVelocity(-1)
    for milliseconds in (20, 40, 60):
        tell(milliseconds)
    assert [(list(each.name), list(each.velocity)) for each in commands] == [
        ([LEFT, RIGHT], [0.0, 0.0]),
        ([LEFT, RIGHT], [1.0, -1.0]),
    ]
    tell(130)  # told again: the world may have been started anew
    assert list(commands[-1].velocity) == [1.0, -1.0]
    assert len(commands) == 3


@pytest.mark.slow
def test_position_control_reaches_its_angle_and_holds_it(system: System, world: str) -> None:
    states = system.messages("/joint_states")
    system.start(simulation.SimulatedWorld, parameters={"world": world})
    node = system.start(WebotsController)
    motor, sensor = node.robot.getDevice(LEFT), node.robot.getDevice("left wheel sensor")
    other = node.robot.getMotor(RIGHT)
    sensor.enable(20)
    for each in (motor, other):
        each.setPosition(3.0)
        each.setVelocity(1.5)
    assert (motor.getTargetPosition(), motor.getVelocity(), motor.getMaxVelocity()) == (3.0, 1.5, 10.0)
    system.run(8.0)
    assert max(max(each.velocity) for each in states) < 1.6
    assert sensor.getValue() == pytest.approx(3.0, abs=0.02)
    assert motor.getPositionSensor().getName() == LEFT


def test_what_is_no_number_moves_nothing(system: System, world: str) -> None:
    odometry = system.messages("/odom")
    system.start(simulation.SimulatedWorld, parameters={"world": world})
    driver = system.start(Driver)
    command(system, math.nan)
    driver.left.setPosition(math.nan)
    system.run(1.0)
    command(system, math.inf)
    system.run(0.5)
    command(system, 1.0)
    system.run(1.0)
    assert odometry[-1].twist.twist.linear.x == pytest.approx(0.1)
    assert f"motor '{LEFT}': setVelocity was given nan: ignored" in log(system)
    assert f"motor '{LEFT}': setPosition was given NaN: ignored" in log(system)


def test_sensors(system: System, world: str) -> None:
    node = system.start(WebotsController)
    names = ("LDS-01", "ds 0", "bumper", "gyro", "accelerometer", "inertial unit")
    lidar, distance, bumper, gyro, accelerometer, unit = map(node.robot.getDevice, names)
    for each in (lidar, distance, bumper, gyro, accelerometer, unit):
        each.enable(32)
        assert each.getSamplingPeriod() == 32
    assert (lidar.getRangeImage(), lidar.getHorizontalResolution()) == ([], 0)
    assert math.isnan(distance.getValue())
    assert all(map(math.isnan, gyro.getValues()))
    assert all(map(math.isnan, unit.getRollPitchYaw()))
    system.start(simulation.SimulatedWorld, parameters={"world": world})
    system.run(0.1)
    for each in (lidar, distance, bumper, gyro, accelerometer, unit):
        each.enable(32)
    system.run(1.0)
    image = lidar.getRangeImage()
    assert (len(image), lidar.getHorizontalResolution(), lidar.getNumberOfLayers()) == (181, 181, 1)
    assert lidar.getFov() == pytest.approx(math.pi, abs=1e-5)
    assert (lidar.getMinRange(), lidar.getMaxRange()) == (pytest.approx(0.1), 15.0)
    assert image[0] == pytest.approx(10.0)  # left
    assert image == lidar.getLayerRangeImage(0)
    assert distance.getValue() == pytest.approx(10.0, abs=0.01)
    assert (distance.getMinValue(), distance.getMaxValue()) == (0.0, 12.0)
    assert bumper.getValue() == 0.0
    assert gyro.getValues() == [0.0, 0.0, 0.0]
    assert accelerometer.getValues() == pytest.approx([0.0, 0.0, 9.81], abs=1e-6)
    assert unit.getRollPitchYaw() == pytest.approx([0.0, 0.0, 0.0])
    assert unit.getQuaternion() == pytest.approx([0.0, 0.0, 0.0, 1.0])
    distance.disable()
    assert math.isnan(distance.getValue())
    with pytest.raises(IndexError, match="lidar 'LDS-01' has no layer 1, only layer 0"):
        lidar.getLayerRangeImage(1)
    with pytest.raises(AttributeError, match=r"device 'bumper' has no getTargets\(\) here"):
        bumper.getTargets()


@pytest.mark.slow
def test_the_lidars_first_value_is_on_the_left(system: System, world: str) -> None:
    system.start(simulation.SimulatedWorld, parameters={"world": world})
    driver = system.start(Driver)
    lidar = driver.robot.getLidar("LDS-01")
    system.run(0.1)
    lidar.enable(32)
    command(system, 0.0, -2.0)  # to the right, so that the left side comes to see what was ahead
    system.run(1.0)
    command(system, 3.0)
    system.run(10.0)
    image = lidar.getRangeImage()
    assert image[0] != pytest.approx(image[-1], abs=0.1)
    scan = lidar.latest
    assert scan is not None
    assert image[0] == pytest.approx(float(scan.ranges[-1]))


def test_a_wrong_name_is_told_with_the_nearest(system: System, world: str) -> None:
    system.start(made_with(Driver, left="left wheel motr"))
    system.start(simulation.SimulatedWorld, parameters={"world": world})
    system.run(0.5)
    known = f"there is: '{LEFT}', '{RIGHT}'"
    assert f"no motor is called 'left wheel motr' (did you mean '{LEFT}'?); {known}" in log(system)
    later = system.start(made_with(WebotsController, node_name="later"))
    system.run(0.5)
    with pytest.raises(
        NotFoundError, match=r"no motor named 'right weel motor' in this robot \(did you mean 'right wheel"
    ):
        later.robot.getMotor("right weel motor")
    with pytest.raises(NotFoundError, match="no motor named 'nothing' in this robot"):
        later.robot.getDevice("nothing").setVelocity(1.0)


@pytest.mark.slow
def test_one_of_several_robots(system: System, tmp_path: Path) -> None:
    path = tmp_path / "two.wbt"
    path.write_text(WORLD + WORLD[WORLD.index("Robot {") :].replace("cart", "my cart").replace("0 0 0.1", "0 3 0.1"))
    system.start(simulation.SimulatedWorld, parameters={"world": str(path)})
    first, second = system.messages("/cart/odom"), system.messages("/my_cart/odom")
    system.start(made_with(WebotsController, node_name="lost"))
    driver = system.start(Driver, parameters={"robot": "my cart"})
    driver.left.setVelocity(1.0)
    driver.right.setVelocity(1.0)
    system.run(6.0)
    assert second[-1].twist.twist.linear.x == pytest.approx(0.1)
    assert first[-1].twist.twist.linear.x == 0.0
    others = "there is /cart/joint_states, /my_cart/joint_states: the parameter 'robot' says whose is meant"
    assert f"nothing is heard on /joint_states: {others}" in log(system)


@pytest.mark.parametrize(
    ("environ", "name"),
    [
        ({}, ""),
        ({"WEBOTS_CONTROLLER_URL": "ipc://1234/my%20robot"}, "my robot"),
        ({"WEBOTS_CONTROLLER_URL": "tcp://10.0.0.5:1234/r1"}, "r1"),
        ({"WEBOTS_CONTROLLER_URL": "1234"}, ""),
        ({"WEBOTS_CONTROLLER_URL": "ipc://1234", "WEBOTS_ROBOT_NAME": "r2"}, "r2"),
    ],
)
def test_the_robots_name_in_the_environment(environ: dict[str, str], name: str) -> None:
    assert robot_name(environ) == name


LOOP = """
import math
import robolink
from robolink.webots_controller.webots_controller import WebotsController


def main():
    robolink.init()
    node = WebotsController()
    node.times = []
    for name in ("left wheel motor", "right wheel motor"):
        motor = node.robot.getDevice(name)
        motor.setPosition(math.inf)
        motor.setVelocity(1.0)
    while node.robot.step(100) != -1:
        node.times.append(node.robot.getTime())
    node.get_logger().info("the loop is over")


if __name__ == "__main__":
    main()
"""


def test_a_program_with_a_loop_of_its_own_ends_with_its_context(system: System, world: str, tmp_path: Path) -> None:
    system.start(simulation.SimulatedWorld, parameters={"world": world})
    (tmp_path / "loop.py").write_text(LOOP)
    node = system.start(tmp_path / "loop.py")
    system.wait_until(lambda: len(node.times) == 20)
    assert node.robot.getBasicTimeStep() == pytest.approx(20.0)
    assert {round(after - before, 9) for before, after in itertools.pairwise(node.times)} == {0.1}
    assert node.robot.positions[LEFT] == pytest.approx(2.0, abs=0.3)
    system.stop(node)
    system.expect_log("the loop is over", within=0.0)


def test_a_step_within_a_callback_is_refused(system: System) -> None:
    node = system.start(WebotsController)
    errors = list[BaseException]()

    def callback() -> None:
        try:
            node.robot.step(32)
        except StepError as error:
            errors.append(error)

    node.create_timer(0.1, callback)
    system.run(0.15)
    assert [str(each) for each in errors] == [
        "robot.step() is for the loop of a program that does not spin: leave it out of callbacks"
    ]


COURSE = Path(os.environ.get("ROBOLINK_COURSE") or Path(__file__).parents[3] / "shared" / "course")
TEXT = "\n".join(each.read_text(encoding="utf-8") for each in sorted(COURSE.glob("*.txt")))


@pytest.mark.skipif(not TEXT, reason=f"the course's text is not at {COURSE} (ROBOLINK_COURSE names another place)")
def test_the_courses_world_and_controller_as_they_stand(system: System, tmp_path: Path) -> None:
    found = re.search(r"^#VRML_SIM.*?^}$(?=\n\nController)", TEXT, re.MULTILINE | re.DOTALL)
    program = re.search(r"^class WebotsRoboController.*?(?=^def main)", TEXT, re.MULTILINE | re.DOTALL)
    assert found
    assert program
    (tmp_path / "meu_mundo.wbt").write_text(found[0], encoding="utf-8")

    names: dict[str, Any] = {"WebotsController": WebotsController, "Twist": Twist}
    exec(program[0], names)
    odometry = system.messages("/odom")
    system.start(simulation.SimulatedWorld, parameters={"world": str(tmp_path / "meu_mundo.wbt")})
    system.start(names["WebotsRoboController"])
    system.run(0.5)
    for _ in range(10):
        command(system, 0.5)
        system.run(1.0)
    assert odometry[-1].pose.pose.position.x == pytest.approx(0.75, abs=0.02)  # 10 s at 0.5 rad/s, radius 0.15 m
    assert odometry[-1].pose.pose.position.y == pytest.approx(0.0, abs=1e-9)
    command(system, 0.0, 0.5)
    system.run(1.0)
    assert odometry[-1].twist.twist.angular.z == pytest.approx(0.5)
    assert "/scan" not in dict(system.node.get_topic_names_and_types())
    guessed = "meu_robo: nothing says what 'motor_esquerdo', 'motor_direito' turn: taken as wheels, radius 0.15 m"
    told = [each for each in log(system) if "meu_mundo.wbt: " in each]
    assert told == [f"{tmp_path / 'meu_mundo.wbt'}: {guessed}, at the sides of the body"]


def test_ros_2s_name_for_it() -> None:
    assert room_of("webots_ros2_driver.webots_controller") == WebotsController.__module__
