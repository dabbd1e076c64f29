"""Robots of Webots as robots of this simulator: outline, mass, wheels, limits, sensors, names."""

from __future__ import annotations

import math

import pytest

from robolink.exceptions import DocumentError
from robolink.sim import World
from robolink.sim.description import RobotDescription, Shape, WorldDescription
from robolink.sim.quantities import Pose
from robolink.sim.sensors import Bumper, Camera, Encoders, Imu, Lidar, RangeFinder, Sensor
from robolink.sim.webots import read
from robolink.sim.webots.robots import _side as side_of
from robolink.sim.webots.sensors import rate_near

HEADER = "#VRML_SIM R2023b utf8\n"
BODY = "Shape { geometry Box { size 0.4 0.3 0.2 } }"


def world(text: str) -> tuple[WorldDescription, tuple[str, ...]]:
    found = read("w.wbt", HEADER + text)
    return found.description, found.notes


def robot(inside: str, more: str = "") -> RobotDescription:
    description, _ = world(f'Robot {{ name "r" children [ {inside} ] {more} }}')
    (found,) = description.robots
    return found


def notes(inside: str, more: str = 'name "r"') -> tuple[str, ...]:
    return world(f"Robot {{ children [ {inside} ] {more} }}")[1]


def wheel(name: str, y: float, axis: str = "0 1 0", more: str = "", x: float = 0.0) -> str:
    """A wheel of 0.05 m radius; its cylinder stands, turned into the direction of the axis y."""
    return f"""HingeJoint {{
        jointParameters HingeJointParameters {{ axis {axis} anchor {x} {y} 0.05 }}
        device [ RotationalMotor {{ name "{name}" {more} }} PositionSensor {{ name "{name} sensor" }} ]
        endPoint Solid {{ translation {x} {y} 0.05 rotation 1 0 0 1.5707963
          children [ DEF TYRE Shape {{ geometry Cylinder {{ radius 0.05 height 0.02 }} }} ]
          boundingObject USE TYRE physics Physics {{ mass 0.1 density -1 }} }} }}"""


WHEELS = wheel("left wheel", 0.16) + wheel("right wheel", -0.16)


def test_wheels_limits_and_mass() -> None:
    found = robot(BODY + WHEELS, "translation 1 2 0.5 rotation 0 0 1 0.25 physics Physics { mass 2 density -1 }")
    assert found.pose == Pose(1, 2, 0.25)
    assert [(each.motor, each.at, each.radius, each.speed_max) for each in found.wheels] == [
        ("left wheel", Pose(0, 0.16, 0.0), 0.05, 10.0),
        ("right wheel", Pose(0, -0.16, 0.0), 0.05, 10.0),
    ]
    assert found.mass == pytest.approx(2.2)
    assert (found.drive.type, found.drive.v_max) == ("diff", 0.5)
    assert found.drive.w_max == pytest.approx(0.5 / 0.16)
    assert found.shape.polygon is not None
    assert max(y for _, y in found.shape.polygon) == pytest.approx(0.17)
    assert robot(BODY + WHEELS).mass == pytest.approx(0.2)  # the wheels have physics
    assert robot(BODY).mass == RobotDescription("r", Pose(0, 0)).mass


def test_the_world_turns_the_wheels_as_webots_would() -> None:
    description, _ = world(f'WorldInfo {{ basicTimeStep 10 }} Robot {{ name "r" children [ {BODY} {WHEELS} ] }}')
    made = World(description)
    made.robots["r"].turn_wheels({"left wheel": 2.0, "right wheel": 2.0})
    for _ in range(200):
        made.step()
    assert made.robots["r"].twist.v == pytest.approx(0.1)
    made.robots["r"].turn_wheels({"left wheel": -2.0, "right wheel": 2.0})
    for _ in range(200):
        made.step()
    assert made.robots["r"].twist.w == pytest.approx(0.1 / 0.16)


def test_a_wheel_whose_axis_points_to_the_right_rolls_backwards() -> None:
    left, right = robot(BODY + wheel("a", 0.16, "0 -1 0") + wheel("b", -0.16, "0 -1 0")).wheels
    assert abs(left.at.theta) == abs(right.at.theta) == pytest.approx(math.pi)


def test_a_robot_whose_wheels_roll_to_its_side_is_turned_round() -> None:
    sideways = BODY + wheel("a", 0.0, "-1 0 0", x=0.2) + wheel("b", 0.0, "-1 0 0", x=-0.2)
    sideways += "DistanceSensor { translation 0 0.15 0 rotation 0 0 1 1.5707963267948966 }"
    found = robot(sideways.replace("rotation 1 0 0 1.5707963", "rotation 0 1 0 1.5707963"))
    assert found.pose.theta == pytest.approx(math.pi / 2)
    assert [(round(each.at.x, 6), round(each.at.y, 6), round(each.at.theta, 6)) for each in found.wheels] == [
        (0, -0.2, 0),
        (0, 0.2, 0),
    ]
    (sensor,) = found.sensors
    assert isinstance(sensor, RangeFinder)
    assert sensor.offset.x == pytest.approx(0.15)
    assert sensor.offset.theta == pytest.approx(0.0)


def test_motors_of_which_only_the_name_is_known() -> None:
    joints = "".join(f'HingeJoint {{ device RotationalMotor {{ name "{name}" }} }}' for name in ("direito", "esquerdo"))
    right, left = robot(BODY + joints).wheels
    assert (right.motor, right.at, right.radius) == ("direito", Pose(0, -0.15), 0.2)
    assert (left.motor, left.at) == ("esquerdo", Pose(0, 0.15))
    assert notes(BODY + joints) == (
        "r: nothing says what 'direito', 'esquerdo' turn: taken as wheels, radius 0.2 m, at the sides of the body",
    )


@pytest.mark.parametrize(
    ("name", "index", "side"),
    [
        ("motor_esquerdo", 1, 1),
        ("motor_direito", 0, -1),
        ("wheel_left_joint", 1, 1),
        ("RIGHT", 0, -1),
        ("motor l", 1, 1),
        ("m_r", 0, -1),
        ("roda 1", 0, 1),
        ("roda 2", 1, -1),
        ("straight", 0, 1),
    ],
)
def test_which_side_a_name_means(name: str, index: int, side: int) -> None:
    assert side_of(name, index) == side


def test_what_cannot_drive_is_left_to_cmd_vel() -> None:
    arm = """HingeJoint { jointParameters HingeJointParameters { axis 0 0 1 } device RotationalMotor { name "arm" }
             endPoint Solid { children [ Shape { geometry Box { size 0.1 0.1 0.1 } } ] } }"""
    assert notes(BODY + arm) == (
        "r: left out, since it turns no wheel: 'arm'",
        "r: no motor turns its wheels, only cmd_vel drives it",
    )
    lonely = BODY + wheel("one", 0.1)
    assert robot(lonely).wheels == ()
    assert notes(lonely)[0] == "r: its motors are left out: one wheel cannot turn the robot: put one on each side"
    assert robot(BODY).drive.type == "diff"
    assert notes(BODY) == ("r: no motor turns its wheels, only cmd_vel drives it",)


def test_three_wheels_that_roll_three_ways_are_an_omnidirectional_drive() -> None:
    wheels = ""
    for index in range(3):
        angle = index * math.tau / 3
        x, y = 0.2 * math.cos(angle), 0.2 * math.sin(angle)
        one = wheel(f"w{index}", y, f"{math.cos(angle)} {math.sin(angle)} 0", x=x)
        wheels += one.replace("rotation 1 0 0 1.5707963", f"rotation {-math.sin(angle)} {math.cos(angle)} 0 1.5707963")
    found = robot(BODY + wheels)
    assert found.drive.type == "omni"
    assert [round(each.radius, 4) for each in found.wheels] == [0.05] * 3


def test_a_robot_without_shape_or_motor_only_looks_on() -> None:
    assert world('Robot { name "judge" supervisor TRUE }') == (WorldDescription(world=world("")[0].world), ())


def test_devices_of_joints_that_are_not_known_are_told_of() -> None:
    _, told = world(f"Robot {{ children [ {BODY} {WHEELS.replace('RotationalMotor', 'RotacionalMotor')} ] }}")
    assert told == (
        "not known here, so this is not there: RotacionalMotor (2 times)",
        "robot: no motor turns its wheels, only cmd_vel drives it",
    )


def test_names_as_ros_has_them() -> None:
    text = f'Robot {{ name "my robot" children [ {BODY} {WHEELS} ] }}'
    moved = text.replace("{ name", "{ translation 2 0 0 name", 1)
    description, told = world(text + moved + moved.replace("2 0 0", "4 0 0").replace("my robot", "2nd"))
    assert [each.name for each in description.robots] == ["my_robot", "my_robot_2", "robot_2nd"]
    assert told == (
        "my_robot: this is how the robot 'my robot' is called here",
        "my_robot_2: this is how the robot 'my robot' is called here",
        "robot_2nd: this is how the robot '2nd' is called here",
    )
    (accented,) = world(text.replace("my robot", "meu_robô"))[0].robots
    assert accented.name == "meu_robo"
    twice = robot(BODY + WHEELS.replace("right wheel", "left wheel"))
    assert [each.motor for each in twice.wheels] == ["left wheel", "left wheel_2"]


def sensors(inside: str) -> tuple[Sensor, ...]:
    return robot(BODY + WHEELS + inside).sensors


def test_a_lidar() -> None:
    text = """Lidar { translation 0.1 0 0.1 rotation 0 0 1 0.5 fieldOfView 3.141592653589793 horizontalResolution 181
              minRange 0.05 maxRange 8 noise 0.001 }"""
    (found,) = sensors(text)
    assert isinstance(found, Lidar)
    assert (found.topic, found.beams, found.fov, found.range) == ("scan", 181, 180.0, (0.05, 8.0))
    assert found.noise == pytest.approx(0.008)
    assert found.offset == Pose(0.1, 0.0, 0.5)
    assert found.rate == pytest.approx(1 / 0.096)
    (default,) = sensors('Lidar { name "LDS-01" type "rotating" }')
    assert isinstance(default, Lidar)
    assert (default.topic, default.beams, default.fov, default.range) == ("scan", 512, 360.0, (0.01, 1.0))
    (bought,) = sensors("Solid { translation 0 0.1 0 children [ RobotisLds01 { } ] }")
    assert isinstance(bought, Lidar)
    assert (bought.topic, bought.beams, bought.range, bought.offset) == ("scan", 360, (0.12, 3.5), Pose(0, 0.1))
    assert [each.topic for each in sensors('Lidar { name "front" } Lidar { }')] == ["front", "lidar"]
    assert notes(f"{BODY} {WHEELS} Lidar {{ fieldOfView 0 }}", 'name "r"')[-1].endswith(
        "Lidar.fieldOfView: expected more than 0, got 0; 1.5708 is used"
    )


def test_noise_of_a_lidar_is_a_share_of_its_range() -> None:
    (ours,) = sensors("RobotisLds01 { }")
    assert isinstance(ours, Lidar)
    assert ours.noise == pytest.approx(0.0043 * 3.5)
    (sick,) = sensors("SickLms291 { noise 0.001 }")
    assert isinstance(sick, Lidar)
    assert sick.noise == pytest.approx(0.08)
    assert sick.range == (0.01, 80.0)


@pytest.mark.parametrize(
    ("field", "report"),
    [
        ("minRange 2", "Lidar.minRange: expected 0 to less than maxRange, 1, got 2"),
        ("horizontalResolution 1", "Lidar.horizontalResolution: expected 2 to 100000 beams, got 1"),
    ],
)
def test_an_impossible_lidar(field: str, report: str) -> None:
    with pytest.raises(DocumentError, match=report):
        sensors(f"Lidar {{ {field} }}")


def test_distance_sensors_tell_metres() -> None:
    text = """DistanceSensor { name "ds0" translation 0.2 0 0 lookupTable [ 0 0 0, 2 2 0 ] type "sonar" }
              DistanceSensor { name "ds 1" numberOfRays 4 aperture 0.5 }"""
    first, second = sensors(text)
    assert isinstance(first, RangeFinder)
    assert isinstance(second, RangeFinder)
    assert (first.topic, first.range, first.radiation, first.fov) == ("ds0", (0.0, 2.0), "ultrasound", 1.0)
    assert (second.topic, second.range, second.radiation) == ("ds_1", (0.0, 0.1), "infrared")
    assert second.fov == pytest.approx(math.degrees(0.5))
    assert notes(BODY + WHEELS + text) == ("r: metres, not what the lookupTable says, come from 'ds 1'",)
    for table in ("0.05 1000 0 0.8 0 0", "0.8 0 0 0.05 1000 0"):
        (sharp,) = sensors(f"DistanceSensor {{ lookupTable [ {table} ] }}")
        assert isinstance(sharp, RangeFinder)
        assert sharp.range == (0.05, 0.8)
    with pytest.raises(DocumentError, match="lookupTable: expected rows of distance, value and noise"):
        sensors("DistanceSensor { lookupTable [ 0 0 0 1 ] }")


def test_other_sensors() -> None:
    text = """TouchSensor { name "bumper" translation 0.2 0 0 } TouchSensor { } Gyro { } Accelerometer { }
              InertialUnit { } LED { } Camera { name "eye" } GPS { }"""
    front, whole, _, imu = sensors(text)
    assert front == Bumper("bumper", rate=rate_near(10, 0.032), fov=180.0, start=-90.0)
    assert whole == Bumper("touch_sensor", rate=rate_near(10, 0.032))
    assert imu == Imu("imu", rate=rate_near(50, 0.032))
    assert notes(BODY + WHEELS + text) == ("r: left out: GPS",)


def test_cameras_are_where_they_are_and_look_where_they_look() -> None:
    text = """Pose { translation 0.1 0 0.15 rotation 0 1 0 0.5 children [
                Camera { name "front eye" fieldOfView 1.0472 width 160 height 120 noise 0.02 } ] }
              Camera { translation -0.1 0 0.2 rotation 0 0 1 3.14159265 }"""
    front, back = sensors(text)
    assert isinstance(front, Camera)
    assert isinstance(back, Camera)
    assert (front.camera, front.width, front.height) == ("front_eye", 160, 120)
    assert front.noise == pytest.approx(5.1)
    assert front.fov == pytest.approx(60.0, abs=1e-3)
    assert front.offset == Pose(0.1, 0.0, 0.0)
    assert [front.z, front.pitch] == pytest.approx([0.15, math.degrees(0.5)])
    assert (back.camera, back.width, back.height) == ("camera", 64, 64)
    assert back.fov == pytest.approx(45.0)
    assert abs(back.offset.theta) == pytest.approx(math.pi)
    assert not (front.depth)
    assert not (back.depth)


def test_a_range_finder_is_a_camera_of_depths() -> None:
    (found,) = sensors("RangeFinder { width 32 height 24 minRange 0.2 maxRange 4 translation 0 0 0.1 }")
    assert isinstance(found, Camera)
    assert (found.camera, found.depth, found.range, found.width) == ("range_finder", True, (0.2, 4.0), 32)
    text = f"Robot {{ children [ {BODY} RangeFinder {{ minRange 2 }} ] }}"
    with pytest.raises(
        DocumentError, match=r"RangeFinder\.minRange: expected more than 0 to less than maxRange, 1, got 2"
    ):
        world(text)


def test_a_camera_stands_as_high_above_the_floor_as_its_robot() -> None:
    found, _ = world(f"Floor {{ translation 0 0 1 }} Robot {{ translation 0 0 1.1 children [ {BODY} Camera {{ }} ] }}")
    (eye,) = found.robots[0].sensors
    assert isinstance(eye, Camera)
    assert eye.z == pytest.approx(0.1)


def test_strange_cameras_are_brought_into_range() -> None:
    (eye,) = sensors("Camera { width 100000 height 0 fieldOfView 6.28 noise -1 translation 0 0 -5 }")
    assert isinstance(eye, Camera)
    assert (eye.width, eye.height, eye.fov, eye.noise, eye.z) == (4096, 1, 170.0, 0.0, 0.005)


def test_robots_keep_their_heights_and_colours() -> None:
    red = "appearance Appearance { material Material { diffuseColor 1 0 0 } }"
    found = robot(f"Shape {{ {red} geometry Box {{ size 0.4 0.3 0.2 }} }}")
    assert found.height == pytest.approx(0.2)
    assert found.colour == "#ff0000"
    assert robot(BODY).colour is None


def test_position_sensors_that_count_ticks() -> None:
    ticking = WHEELS.replace("PositionSensor { name", "PositionSensor { resolution 0.00628318530718 name")
    assert robot(BODY + WHEELS).sensors == ()  # joint_states tells the angles exactly
    (found,) = robot(BODY + ticking).sensors
    assert found == Encoders("encoders", rate=rate_near(50, 0.032), ticks=1000)


def test_a_sensor_with_a_name_that_is_taken() -> None:
    found = sensors('DistanceSensor { name "odom" } DistanceSensor { name "ds" } DistanceSensor { name "ds" }')
    assert [each.topic for each in found] == ["odom_2", "ds", "ds_2"]


def test_a_robot_on_the_edge_of_its_own_outline_is_a_circle() -> None:
    found = robot("Pose { translation 0.5 0 0 children [ Shape { geometry Box { size 0.2 0.2 0.2 } } ] }")
    assert found.shape == Shape(circle=found.shape.circle)
    assert found.shape.circle == pytest.approx(math.hypot(0.6, 0.1))


@pytest.mark.parametrize("dt", [0.001, 0.008, 0.016, 0.032, 0.064])
def test_rates_are_whole_numbers_of_steps(dt: float) -> None:
    for wanted in (10.0, 50.0):
        steps = 1 / (rate_near(wanted, dt) * dt)
        assert steps == pytest.approx(round(steps))
        assert round(steps) >= 1
