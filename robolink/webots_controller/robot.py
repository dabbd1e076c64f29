"""Webots' class `Robot`: devices by name, commands to motors at each step of the world, and `step`."""

from __future__ import annotations

from typing import Any

from robolink.callback_groups import ReentrantCallbackGroup
from robolink.clock import Clock
from robolink.clock_type import ClockType
from robolink.exceptions import ExternalShutdownException, NotFoundError, RobolinkError, nearest
from robolink.executors import Executor
from robolink.interfaces.sensor_msgs.msg import JointState
from robolink.node import Node
from robolink.publisher import Publisher
from robolink.spinning import spin_once
from robolink.text.names import spelled
from robolink.webots_controller.cameras import Camera, RangeFinder
from robolink.webots_controller.motors import SENSORS, AnyDevice, Motor, PositionSensor
from robolink.webots_controller.sensors import (
    Accelerometer,
    DistanceSensor,
    Gyro,
    InertialUnit,
    Lidar,
    RobotTopics,
    TouchSensor,
    quoted,
    words_of,
)

AGAIN = 100_000_000
"""Period of repeated commands in ns of simulated time: a world stops motors without commands."""

ALONE = 5.0
"""Time without a world after which a warning is logged, in seconds."""

WAIT = 0.5
"""Period in seconds at which a step checks for the end of the context."""

BASIC_STEP = 32.0
"""Webots' default step, in ms."""


class StepError(RobolinkError, RuntimeError):
    """`step` was called where a node is spinning already."""


class Robot:
    """The robot of a `WebotsController`, as Webots' Python API has it; `name` is its own where there are several.

    Devices may be asked for before the world is there. Times are the world's own, as its messages are stamped. `prefix`
    is what the names of its topics begin with; None follows from `name`.
    """

    def __init__(self, node: Node, name: str, prefix: str | None = None) -> None:
        self._node, self._name = node, name
        if prefix is None:
            prefix = f"{spelled(name, 'robot')}/" if name else ""
        self._prefix = prefix
        self.topics = RobotTopics(node, prefix)
        self._motors: dict[str, Motor] = {}
        self.positions: dict[str, float] = {}
        self._first = self._stamp = self._sent_at = 0
        self._step_ns, self._sent = 0, dict[str, float]()
        self._warned: set[str] = set()
        group = ReentrantCallbackGroup()
        self._command: Publisher[JointState] | None = None
        for topic in ("joint_states", "encoders"):
            node.create_subscription(JointState, f"{prefix}{topic}", self._on_joint_states, 10, callback_group=group)
        steady = Clock(clock_type=ClockType.STEADY_TIME, time_base=node.context.time)
        self._alone = node.create_timer(ALONE, self._on_alone, callback_group=group, clock=steady)

    # Devices

    def getDevice(self, name: str) -> Any:
        """Return the device called `name`; its kind follows from the first call.

        Raises `NotFoundError` with the nearest name if the world is there and has none of that name.
        """
        if self._stamp and name not in self.positions and not self._is_a_sensor(name):
            raise NotFoundError("device", name, [*self.positions, *self._sensor_topics()], "this robot")
        return AnyDevice(self, name)

    def getMotor(self, name: str) -> Motor:
        """Return the motor called `name`. Raises `NotFoundError` if the world is there and has none of that name."""
        if self._stamp and name not in self.positions:
            raise NotFoundError("motor", name, self.positions, "this robot")
        if self._command is None:  # from now on the world ignores cmd_vel
            self._command = self._node.create_publisher(JointState, f"{self._prefix}joint_command", 10)
        return self._motors.setdefault(name, Motor(self, name))

    def getPositionSensor(self, name: str) -> PositionSensor:
        """Return the position sensor of the joint that fits `name`."""
        return PositionSensor(self, name)

    def getLidar(self, name: str) -> Lidar:
        """Return the lidar called `name`."""
        return Lidar(self.topics, name)

    def getDistanceSensor(self, name: str) -> DistanceSensor:
        """Return the distance sensor called `name`."""
        return DistanceSensor(self.topics, name)

    def getTouchSensor(self, name: str) -> TouchSensor:
        """Return the bumper called `name`."""
        return TouchSensor(self.topics, name)

    def getInertialUnit(self, name: str) -> InertialUnit:
        """Return the inertial unit called `name`."""
        return InertialUnit(self.topics, name)

    def getGyro(self, name: str) -> Gyro:
        """Return the gyro called `name`."""
        return Gyro(self.topics, name)

    def getAccelerometer(self, name: str) -> Accelerometer:
        """Return the accelerometer called `name`."""
        return Accelerometer(self.topics, name)

    def getCamera(self, name: str) -> Camera:
        """Return the camera called `name`."""
        return Camera(self.topics, name)

    def getRangeFinder(self, name: str) -> RangeFinder:
        """Return the range finder called `name`: a camera of depths."""
        return RangeFinder(self.topics, name)

    def _is_a_sensor(self, name: str) -> bool:
        return bool(self.joint_of(name)) or AnyDevice(self, name).is_there()

    def _sensor_topics(self) -> list[str]:
        found = [(kind, topic) for kind in SENSORS for topic in self.topics.of_type(kind.message)]
        return [topic.removesuffix(kind.topic_of("")) for kind, topic in found if topic.endswith(kind.topic_of(""))]

    def joint_of(self, sensor: str) -> str:
        """Return the joint of a position sensor: by its name, else by most words in common; '' for none."""
        if sensor in self.positions:
            return sensor
        words = words_of(sensor)
        common = {joint: len(words & words_of(joint)) for joint in self.positions}
        best = [joint for joint, count in common.items() if count and count == max(common.values())]
        return best[0] if len(best) == 1 else ""

    # Time

    def getName(self) -> str:
        """Return the robot's name; '' if it is not known."""
        return self._name

    def getTime(self) -> float:
        """Return the simulated time since the world's first message, in seconds."""
        return (self._stamp - self._first) / 1e9

    def getBasicTimeStep(self) -> float:
        """Return the period of the joint states in ms: a shorter step brings nothing new."""
        return self._step_ns / 1e6 or BASIC_STEP

    def step(self, duration: float = 0.0) -> int:
        """Run callbacks until `duration` ms of the world's time have passed (0: one basic step); -1 at the end, else 0.

        Waits for a world that is not there yet. Raises `StepError` within a callback: where a node is spun, the
        world goes on by itself.
        """
        executor = self._node.executor
        if executor is not None and executor.spinning:
            raise StepError("robot.step() is for the loop of a program that does not spin: leave it out of callbacks")
        period = int((duration or self.getBasicTimeStep()) * 1e6)
        start = self._stamp
        while self._node.context.ok():
            if start and self._stamp - start >= period:
                return 0
            start = start or self._stamp
            try:
                self._spin_once(executor)
            except (KeyboardInterrupt, ExternalShutdownException):
                return -1
        return -1

    def _spin_once(self, executor: Executor | None) -> None:
        if executor is None:
            spin_once(self._node, timeout_sec=WAIT)
        else:
            executor.spin_once(timeout_sec=WAIT)

    # The world

    def _on_joint_states(self, state: JointState) -> None:
        stamp = state.header.stamp.sec * 1_000_000_000 + state.header.stamp.nanosec
        if not self._stamp:
            self._first = stamp
            self._alone.cancel()
        elif stamp > self._stamp:
            passed = stamp - self._stamp
            self._step_ns = min(self._step_ns or passed, passed)
        self._first, self._stamp = min(self._first, stamp), stamp
        self.positions.update(zip(state.name, state.position, strict=False))
        self._look_for_motors()
        self._tell_motors()

    def _tell_motors(self) -> None:
        """Send the commands of all motors in one message, if they have changed or the last one is old."""
        speeds = {name: motor.speed() for name, motor in list(self._motors.items()) if motor.is_set}
        speeds = {name: speed for name, speed in speeds.items() if name in self.positions}
        passed = self._stamp - self._sent_at
        if self._command and speeds and (speeds != self._sent or not 0 <= passed < AGAIN):
            self._sent, self._sent_at = speeds, self._stamp
            self._command.publish(JointState(name=list(speeds), velocity=list(speeds.values())))

    def halt(self) -> None:
        """Stop all motors that have had a command."""
        if self._command and self._sent:
            self._command.publish(JointState(name=list(self._sent), velocity=[0.0] * len(self._sent)))

    def _look_for_motors(self) -> None:
        for name in self._motors.keys() - self.positions.keys():
            known = quoted(self.positions)
            self.warn(f"no motor is called '{name}'{nearest(name, self.positions)}; there is: {known}")

    def _on_alone(self) -> None:
        """Warn that there is no world, and what there is instead."""
        self._alone.cancel()
        others = self.topics.elsewhere()
        known = f"there is {', '.join(others)}: the parameter 'robot' says whose is meant" if others else ""
        hint = known or "is 'robolink run world -p world:=FILE.wbt' running?"
        self.warn(f"nothing is heard on {self.topics.joint_states}: {hint}")

    def warn(self, text: str) -> None:
        """Log a warning once."""
        if text not in self._warned:
            self._warned.add(text)
            self._node.get_logger().warning(text)
