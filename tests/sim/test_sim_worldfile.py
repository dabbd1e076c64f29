"""World files: what they may say, and what they are told when they are wrong."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from robolink.exceptions import DocumentError
from robolink.sim import Pose, World, WorldDescription, load_world
from robolink.sim.checks.worlds import problems
from robolink.sim.description import Drive, Obstacle, Shape, steps_between
from robolink.sim.sensors import SENSORS, Lidar
from robolink.sim.worldfile import check_world

WORLDS = Path(__file__).parents[2] / "configs" / "worlds"


def loaded(text: str) -> WorldDescription:
    return load_world("w.yaml", text=text)


@pytest.mark.parametrize("path", sorted(WORLDS.glob("*.yaml")), ids=lambda path: path.stem)
def test_the_worlds_that_come_along_have_robots_with_a_scan(path: Path) -> None:
    world = World(load_world(path))
    assert world.robots
    for robot in world.robots.values():
        assert math.isfinite(robot.scan().ranges.min())
        assert world.nearest_wall_distance(robot.pose.x, robot.pose.y) > 0.3
    assert world.description.world.name == path.stem
    assert check_world(path).errors == []


def test_all_that_a_world_may_say() -> None:
    world = loaded(
        """
        world: {name: hall, size: [10, 8], dt: 0.02, rtf: 0, seed: 7}
        walls:
          - {polyline: [[0, 0], [10, 0], [10, 8]]}
          - {polyline: [[1, 1], [2, 1], [2, 2]], closed: true}
        obstacles:
          - {box: [0.8, 0.4], pose: [3, 2, 0.5]}
          - {circle: 0.25, pose: [5, 5], mass: 2.0}
        robots:
          - name: r1
            pose: [8, 1, -1.5]
            shape: {box: [0.4, 0.3]}
            mass: 5
            drive: {type: diff, v_max: 0.6, w_max: 2.5, a_max: 1, alpha_max: 4, timeout: 1}
            odom: {rate: 25}
            sensors:
              - {lidar: scan, rate: 5, beams: 181, fov: 180, start: -90, range: [0.1, 8], noise: 0.01, dropout: 0.05,
                 offset: [0.1, 0, 0]}
        """
    )
    (robot,) = world.robots
    assert (world.world.name, world.world.dt, world.world.rtf, world.world.seed) == ("hall", 0.02, 0.0, 7)
    assert [len(wall.segments()) for wall in world.walls] == [2, 3]
    assert world.obstacles[1] == Obstacle(circle=0.25, pose=Pose(5.0, 5.0), mass=2.0)
    assert robot.shape == Shape(box=(0.4, 0.3))
    assert robot.drive == Drive("diff", 0.6, 2.5, 1.0, 4.0, 1.0)
    assert robot.sensors == (Lidar("scan", 5.0, 181, 180.0, -90.0, (0.1, 8.0), 0.01, 0.05, Pose(0.1, 0.0, 0.0)),)


def test_everything_has_a_default() -> None:
    assert loaded("{}") == WorldDescription()
    (robot,) = loaded("robots: [{name: r, pose: [1, 2]}]").robots
    assert (robot.shape, robot.drive, robot.pose.theta) == (Shape(circle=0.17), Drive(), 0.0)


ROBOT = "robots: [{name: r, pose: [1, 1], %s}]"
SENSOR = ROBOT % "sensors: [{%s}]"
SHAPE = ROBOT % "shape: {%s}"
DRIVE = ROBOT % "drive: {%s}"
WHEELS = ROBOT % "wheels: [%s]"
OMNI = ROBOT % "drive: {type: omni}, wheels: [%s]"
OBSTACLE = "obstacles: [{%s}]"
MAP = "map: {yaml: %s}"
LEFT, RIGHT = "{motor: left, at: [0, 0.1]}", "{motor: right, at: [0, -0.1]}"
BOW_TIE = "polygon: [[-1, -1], [1, 1], [1, -1], [-1, 1]]"
BAD = {
    # YAML, keys, types and ranges
    "walls: [": "w.yaml:1:",
    "- 1": "w.yaml:1:1: expected mapping, got list",
    "wals: []": "w.yaml:1:1: wals: unknown key 'wals' (did you mean 'walls'?)",
    "walls: 3": "w.yaml:1:8: walls: expected list, got '3'",
    "world: {dt: 0}": "w.yaml:1:13: world.dt: expected float >= 0.0001, got '0'",
    "world: {rtf: -1}": "w.yaml:1:14: world.rtf: expected float >= 0.0, got '-1'",
    "world: {seed: -1}": "world.seed: expected int >= 0, got '-1'",
    "world: {size: [4]}": "w.yaml:1:15: world.size: expected list of length 2, got 1",
    "robots: [{name: r}]": "1:10: robots[0]: missing key 'pose'",
    "robots: [{name: r, pose: [1]}]": "robots[0].pose: expected list of at least length 2, got 1",
    "robots: [{name: r, pose: [1, 1, 90]}]": "1:33: robots[0].pose[2]: expected float <= 6.2832, got '90'",
    ROBOT % "drve: {}": "1:34: robots[0].drve: unknown key 'drve' (did you mean 'drive'?)",
    ROBOT % "mass: 1, mass: 2": "1:43: key 'mass' is given twice",
    ROBOT % "mass: 0": "robots[0].mass: expected float >= 0.001, got '0'",
    ROBOT % "ground_truth: 3": "1:48: robots[0].ground_truth: expected mapping, got '3'",
    # drives
    DRIVE % "vmax: 1": "1:42: robots[0].drive.vmax: unknown key 'vmax' (did you mean 'v_max'?)",
    DRIVE % "v_max: fast": "1:49: robots[0].drive.v_max: expected float, got 'fast'",
    DRIVE % "v_max: 0": "robots[0].drive.v_max: expected float >= 0.001, got '0'",
    DRIVE % "v_max: .nan": "robots[0].drive.v_max: expected float >= 0.001, got '.nan'",
    DRIVE % "v_max: .inf": "robots[0].drive.v_max: expected float <= 1000.0, got '.inf'",
    DRIVE % "v_max: 30": "v_max: 30 m/s is 0.3 m in a step of 0.01 s, and a shape of 0.17 m could pass through walls",
    DRIVE % "w_max: 400": "drive.w_max: more than a quarter turn in a step of 0.01 s: at most 157.1",
    ROBOT % "shape: {box: [1, 0.1]}, drive: {w_max: 20}": "1:73: robots[0].drive.w_max: at 0.5 m/s and 20 rad/s its "
    "corners go 0.0955 m in a step of 0.01 s, and a shape of 0.05 m could pass through walls: at most 9.9",
    ROBOT % "shape: {box: [1, 0.2]}, drive: {v_max: 10}": "1:65: robots[0].drive.w_max: at 10 m/s and 2 rad/s its "
    "corners go 0.108 m in a step of 0.01 s, and a shape of 0.1 m could pass through walls: it needs a lower v_max",
    DRIVE % "timeout: 0.001": "1:51: robots[0].drive.timeout: shorter than a step, so that no command would count",
    DRIVE % "type: dif": "1:48: robots[0].drive.type: expected one of diff, omni, ackermann, got 'dif' (did you",
    DRIVE
    % "wheelbase: 0.3": "1:42: robots[0].drive.wheelbase: a drive of type 'diff' has no 'wheelbase': leave it out, or",
    DRIVE % "type: omni, steer_max: 0.5": "1:54: robots[0].drive.steer_max: a drive of type 'omni' has no 'steer_max'",
    DRIVE % "steer_rate: 2": "robots[0].drive.steer_rate: a drive of type 'diff' has no 'steer_rate'",
    DRIVE % "type: ackermann, steer_max: 2": "robots[0].drive.steer_max: expected float <= 1.5, got '2'",
    DRIVE % "type: ackermann, wheelbase: 3": "axles 3 m apart do not fit a robot of 0.34 m: at most 0.34",
    DRIVE % "type: ackermann, wheelbase: 0.001": "more than a quarter turn in a step of 0.01 s: at least 0.001739",
    # masses
    f"{OBSTACLE}\n{ROBOT}"
    % ("circle: 0.1, pose: [3, 3], mass: 0.02", "mass: 3"): "1:47: obstacles[0].mass: 0.02 kg, which robot 'r' of 3 kg "
    "would push through walls: at least 0.03, or that robot at most 2",
    "robots: [{name: a, pose: [1, 1], mass: 1}, {name: b, pose: [2, 2], mass: 101}]": "1:40: robots[0].mass: 1 kg, "
    "which robot 'b' of 101 kg would push through walls: at least 1.01, or that robot at most 100",
    # wheels
    WHEELS % LEFT: "1:42: robots[0].wheels: one wheel cannot turn the robot: put one on each side",
    WHEELS % f"{LEFT}, {{motor: b, at: [0.1, 0.1]}}": "these wheels cannot turn the robot, all stand 0.1 m to the left",
    WHEELS % f"{LEFT}, {LEFT}": "robots[0].wheels[1].motor: two motors are called 'left': give this one another name",
    WHEELS % f"{LEFT}, {{motor: '', at: [0, -0.1]}}": "wheels[1].motor: expected 1 to 64 letters, got ''",
    WHEELS
    % f"{LEFT}, {{motor: b, at: [0, -0.1, 1.57]}}": "wheels[1].at: a wheel of a drive of type 'diff' rolls ahead",
    WHEELS % f"{LEFT}, {{motor: b, at: [0, -0.1], radius: 0}}": "wheels[1].radius: expected float >= 0.001, got '0'",
    OMNI
    % f"{LEFT}, {RIGHT}": "wheels: these wheels cannot drive it ahead, sideways and round: it takes three that roll",
    # outlines
    ROBOT % "shape: {}": "1:41: robots[0].shape: expected one of 'box', 'circle' and 'polygon', got none of them",
    SHAPE % "box: [1, 1], circle: 1": "expected one of 'box', 'circle' and 'polygon', got box and circle",
    SHAPE % "circle: 0": "robots[0].shape.circle: expected float >= 0.001, got '0'",
    SHAPE % "polygon: [[0, 0], [1, 0]]": "shape.polygon: expected list of length >= 3",
    SHAPE
    % BOW_TIE: "shape.polygon: its edges [-1, -1]-[1, 1] and [1, -1]-[-1, 1] meet: give the corners in their order",
    SHAPE % "polygon: [[-1, 0], [0, 0], [1, 0]]": "its corners lie in one line, and enclose nothing",
    SHAPE
    % "polygon: [[1, 0], [2, 0], [2, 1]]": "shape.polygon: it must go round [0, 0], the point that the robot's pose",
    OBSTACLE % "pose: [1, 1]": "1:13: obstacles[0]: expected one of 'box', 'circle' and 'polygon', got none of them",
    OBSTACLE % "box: [0, 1], pose: [1, 1]": "1:20: obstacles[0].box[0]: expected float >= 0.001, got '0'",
    OBSTACLE
    % "pose: [0, 0], polygon: [[0, 0], [1, 0], [1, 0], [0, 1]]": "1:54: obstacles[0].polygon[2]: an edge from [1,",
    OBSTACLE % "pose: [0, 0], polygon: [[0, 0], [1, 0], [0, 1], [0, 0]]": "polygon[3]: 'polygon' already leads back to",
    OBSTACLE
    % "pose: [0, 0], polygon: [[0, 0], [2, 0], [1, 0], [1, 1]]": "its edges [0, 0]-[2, 0] and [2, 0]-[1, 0] meet",
    OBSTACLE
    % "pose: [0, 0], polygon: [[0, 0], [2, 0], [2, 1], [1, 0], [0, 1]]": "edges [0, 0]-[2, 0] and [1, 0]-[0, 1] meet",
    OBSTACLE
    % "pose: [0, 0], polygon: [[0, 0], [0.01, 0], [0.01, 0.00001]]": "it encloses less than a square millimetre",
    # what moves
    OBSTACLE % "circle: 1": "1:13: obstacles[0]: missing key 'pose': where it stands (or 'path', along which",
    OBSTACLE
    % "circle: 1, pose: [1, 1], speed: 2": "1:39: obstacles[0].speed: only what moves along a 'path' has 'speed'",
    OBSTACLE
    % "circle: 1, pose: [1, 1], closed: true": "obstacles[0].closed: only what moves along a 'path' has 'closed'",
    OBSTACLE
    % "circle: 1, path: [[0, 0], [1, 1]], mass: 2": "1:49: obstacles[0].mass: what moves along a path by itself",
    OBSTACLE % "circle: 1, path: [[0, 0], [1, 1]], pose: [2, 2]": "pose: its path begins at [0, 0]: leave out 'pose'",
    OBSTACLE % "circle: 1, path: [[0, 0]]": "obstacles[0].path: expected list of length >= 2",
    OBSTACLE % "circle: 1, path: [[0, 0], [0, 0]]": "path[1]: a way from [0, 0] to the same point has no length",
    OBSTACLE % "circle: 1, path: [[0, 0], [1, 0], [0, 0]], closed: true": "path[2]: 'closed: true' already leads back",
    OBSTACLE
    % "circle: 0.01, path: [[0, 0], [1, 0]], speed: 5": "obstacles[0].speed: 5 m/s is 0.05 m in a step of 0.01 s",
    # walls
    "walls: [{polyline: [[0, 0]]}]": "1:20: walls[0].polyline: expected list of length >= 2",
    "walls: [{polyline: [[0, 0], [1, 0]], closed: true}]": "a closed wall needs 3 points or more, got 2",
    "walls: [{polyline: [[0, 0], [1, 0], [1, 0]]}]": "walls[0].polyline[2]: a wall from [1, 0] to the same point",
    "walls: [{polyline: [[0, 0], [1, 0], [1, 1], [0, 0]], closed: true}]": "'closed: true' already leads back",
    # sensors
    SENSOR % "lidar: scan, beams: 1": "w.yaml:1:65: robots[0].sensors[0].beams: expected int >= 2, got '1'",
    SENSOR % "lidar: scan, beens: 9": "1:58: robots[0].sensors[0].beens: unknown key 'beens' (did you mean 'beams'?)",
    SENSOR % "rate: 5, imu: imu, noise: {giro: 1}": "sensors[0].noise.giro: unknown key 'giro' (did you mean 'gyro'?)",
    SENSOR % "bumper: bumper, beams: 3": "1:61: robots[0].sensors[0].beams: unknown key 'beams'",
    SENSOR
    % "sonar: scan": "1:44: robots[0].sensors[0]: this sensor has no kind: one of its keys must be lidar, bumper, imu,",
    SENSOR
    % "lidr: scan": "1:44: robots[0].sensors[0]: this sensor has no kind (did you mean 'lidar'?): one of its keys",
    SENSOR % "lidar: scan, imu: imu": "1:44: robots[0].sensors[0]: one sensor cannot be both lidar and imu",
    ROBOT % "sensors: [scan]": "1:44: robots[0].sensors[0]: expected a mapping such as {lidar: scan}, got 'scan'",
    SENSOR % "lidar: 3": "1:52: robots[0].sensors[0].lidar: expected str, got '3'",
    SENSOR % "lidar: 'my scan'": "1:52: robots[0].sensors[0].lidar: 'my scan' is not a name: a-z, A-Z, digits and '_'",
    SENSOR % "lidar: scan}, {imu: scan": "1:65: robots[0].sensors[1].imu: two sensors publish on 'scan': give this one",
    SENSOR % "lidar: odom": "sensors[0].lidar: the simulation itself has a topic 'odom': take another name",
    ROBOT % "wheels: [{motor: a, at: [0, 0.1]}, {motor: b, at: [0, -0.1]}], sensors: [{lidar: joint_states}]": (
        "sensors[0].lidar: the simulation itself has a topic 'joint_states': take another name"
    ),
    SENSOR % "lidar: tf_static": "sensors[0].lidar: the simulation itself has a topic 'tf_static'",
    SENSOR
    % "lidar: scan, rate: 7": "sensors[0].rate: 7 Hz is not a whole number of steps of 0.01 s: take 6.66667 or 7.14286",
    SENSOR % "lidar: scan, range: [5, 2]": "sensors[0].range: the nearest, 5 m, must be less than the farthest, 2 m",
    SENSOR % "lidar: scan, fov: 400": "sensors[0].fov: expected float <= 360.0, got '400'",
    SENSOR
    % "range_finder: s, radiation: radio": "1:73: robots[0].sensors[0].radiation: expected one of ultrasound, infra",
    SENSOR
    % "encoders: wheels": "1:44: robots[0].sensors[0]: encoders count the turns of wheels, and this robot has no",
    # rates and names
    ROBOT % "odom: {rate: 30}": "30 Hz is not a whole number of steps of 0.01 s: take 25 or 33.3333",
    ROBOT % "odom: {rate: 200}": "200 Hz is not a whole number of steps of 0.01 s: take 100",
    ROBOT % "ground_truth: {rate: 30}": "robots[0].ground_truth.rate: 30 Hz is not a whole number of steps",
    "robots: [{name: 7up, pose: [3, 3]}]": "1:17: robots[0].name: '7up' is not a name",
    'robots: [{name: "r\\n", pose: [3, 3]}]': r"'r\n' is not a name",
    "robots: [{name: r, pose: [1, 1]}, {name: r, pose: [3, 3]}]": "1:42: robots[1].name: two robots are called 'r'",
    # places
    "world: {size: [4, 4]}\nrobots: [{name: r, pose: [5, 1]}]": "2:26: robots[0].pose: [5, 1] lies outside of the",
    "world: {size: [4, 4]}\nwalls: [{polyline: [[0, 0], [5, 0]]}]": "walls[0].polyline[1]: [5, 0] lies outside of the",
    "world: {size: [4, 4]}\nobstacles: [{circle: 1, path: [[0, 0], [0, 5]]}]": "obstacles[0].path[1]: [0, 5] lies outs",
    "robots: [{name: r, pose: [1, 1]}, {name: s, pose: [1.2, 1]}]": "robots[0].pose: this starts inside of robots[1]",
    "obstacles: [{box: [2, 2], pose: [1, 1]}]\n"
    + ROBOT % "": "2:26: robots[0].pose: this starts inside of obstacles[0]",
    "obstacles: [{circle: 1, path: [[1, 1], [5, 5]]}]\n"
    + ROBOT % "": "robots[0].pose: this starts inside of obstacles[0]",
    "walls: [{polyline: [[0, 1.1], [9, 1.1]]}]\n" + ROBOT % "": "robots[0].pose: this starts inside of walls[0]",
    "obstacles: [{circle: 1, pose: [1, 1]}, {circle: 1, pose: [1, 1], mass: 1}]": "obstacles[1].pose: this starts",
    "obstacles: [{circle: 1, pose: [0, 0]}, {box: [1, 1], pose: [1, 0]}]": "1:60: obstacles[1].pose: this overlaps obs",
    # maps
    "map: {}": "w.yaml:1:6: map: missing key 'yaml'",
    "map: office.yaml": "w.yaml:1:6: map: expected mapping",
    MAP % "no_such.yaml": "w.yaml:1:13: map.yaml: no file 'no_such.yaml'",
}


@pytest.mark.parametrize(("text", "expected"), BAD.items())
def test_what_is_wrong_is_said_with_its_place(text: str, expected: str) -> None:
    with pytest.raises(DocumentError) as caught:
        loaded(text)
    message = str(caught.value)
    assert message.startswith(("w.yaml:1:", "w.yaml:2:"))
    assert expected in message
    assert "\n" not in message
    assert message in [str(each) for each in check_world("w.yaml", text=text).errors]


KINDS = ", ".join(SENSORS.table())


def test_all_that_is_wrong_is_found_at_once() -> None:
    text = """
        robots:
          - {name: a, pose: [1, one], sensors: [{lidar: 3}, {imu: imu, fov: 3}, {lidr: scan}], color: red}
          - {nam: b, pose: [1, 1]}
        wals: []
        """
    checked = check_world("w.yaml", text=text)
    assert checked.description is None
    assert [str(each).partition(": ")[2] for each in checked.errors] == [
        "robots[0].pose[1]: expected float, got 'one'",
        "robots[0].sensors[0].lidar: expected str, got '3'",
        "robots[0].sensors[1].fov: unknown key 'fov'; there are imu, rate, noise",
        "robots[0].sensors[2]: this sensor has no kind (did you mean 'lidar'?): one of its keys must be " + KINDS,
        "robots[0].color: unknown key 'color' (did you mean 'colour'?)",
        "robots[1].nam: unknown key 'nam' (did you mean 'name'?)",
        "wals: unknown key 'wals' (did you mean 'walls'?)",
    ]


def test_all_that_is_wrong_with_right_types_is_found_at_once() -> None:
    text = (
        ROBOT % "drive: {v_max: 99, wheelbase: 1, timeout: 0.001}, sensors: [{imu: tf}]"
    ) + "\nmap: {yaml: none.yaml}"
    found = [str(each).partition(": ")[2].partition(":")[0] for each in check_world("w.yaml", text=text).errors]
    assert found == [
        "map.yaml",
        "robots[0].drive.wheelbase",
        "robots[0].drive.v_max",
        "robots[0].drive.timeout",
        "robots[0].sensors[0].imu",
    ]


def test_each_pair_that_overlaps_is_told_once() -> None:
    text = "robots: [{name: a, pose: [0, 0]}, {name: b, pose: [0.1, 0]}, {name: c, pose: [5, 0]}]"
    assert len(check_world("w.yaml", text=text).errors) == 1


GOOD = {
    "a drive of each type": "robots: [{name: r, pose: [0, 0], drive: {type: omni}}, {name: s, pose: [1, 0], "
    "drive: {type: ackermann, wheelbase: 0.2, steer_max: 1, steer_rate: 3}}]",
    "wheels on both sides": ROBOT % f"wheels: [{LEFT}, {RIGHT}], sensors: [{{encoders: joint_states}}]",
    "wheels that roll backwards": WHEELS % f"{LEFT}, {{motor: right, at: [0, -0.1, 3.1416]}}",
    "three wheels of an omni drive": OMNI % f"{LEFT}, {RIGHT}, {{motor: rear, at: [-0.1, 0, 1.5708]}}",
    "each kind of sensor": ROBOT % "sensors: [{lidar: scan}, {bumper: b}, {imu: i}, {range_finder: s}]",
    "a concave robot": SHAPE % "polygon: [[-1, -1], [2, -1], [2, 1], [1, 0.5], [-1, 1]]",
    "a path with a heading": OBSTACLE % "box: [1, 1], path: [[0, 0], [5, 0]], pose: [0, 0, 0.5], speed: 1",
    "nothing where something may be": "map:\nobstacles: [{circle: 1, pose: [0, 0], path: , mass: }]",
    "an obstacle in a wall": "walls: [{polyline: [[0, 0], [9, 0]]}]\nobstacles: [{circle: 1, pose: [4, 0]}]",
    "two boxes side by side": "obstacles: [{box: [1, 1], pose: [0, 0]}, {box: [1, 1], pose: [1, 0]}]",
    "a robot in the corner of an L": "obstacles: [{polygon: [[0, 0], [3, 0], [3, 1], [1, 1], [1, 3], [0, 3]], "
    "pose: [0, 0]}]\nrobots: [{name: r, pose: [1.5, 1.5]}]",
}


@pytest.mark.parametrize("text", GOOD.values(), ids=list(GOOD))
def test_what_is_right_is_read(text: str) -> None:
    assert check_world("w.yaml", text=text).errors == []
    assert loaded(text) == check_world("w.yaml", text=text).description


@pytest.mark.annex("webots")
def test_a_webots_world_is_read_by_its_suffix(monkeypatch: pytest.MonkeyPatch) -> None:
    from robolink.sim import webots

    asked = []

    def load(path: str, text: str | None) -> WorldDescription:
        asked.append((path, text))
        return WorldDescription()

    monkeypatch.setattr(webots, "load", load)
    assert load_world("a.WBT", text="#VRML_SIM") == WorldDescription()
    assert check_world("b.wbt").errors == []
    assert asked == [("a.WBT", "#VRML_SIM"), ("b.wbt", None)]


def test_what_only_touches_does_not_overlap() -> None:
    text = "walls: [{polyline: [[0, 0], [9, 0]]}]\nobstacles: [{box: [1, 1], pose: [5, 0.5], mass: 1}]\n"
    world = loaded(text + "robots: [{name: r, pose: [1, 0.17]}]")
    assert list(problems(world)) == []


@pytest.mark.parametrize(
    ("rate", "dt", "steps"),
    [(10, 0.01, 10), (50, 0.01, 2), (100, 0.01, 1), (30, 0.01, 0), (200, 0.01, 0), (100 / 3, 0.01, 3)],
)
def test_rates_are_whole_numbers_of_steps(rate: float, dt: float, steps: int) -> None:
    assert steps_between(rate, dt) == steps
