"""The messages of control_msgs: commands to controllers, and what controllers report."""

from typing import ClassVar

from robolink.interfaces.builtin_interfaces.msg import Duration
from robolink.interfaces.geometry_msgs.msg import (
    PoseStamped,
    Quaternion,
    TransformStamped,
    Twist,
    TwistStamped,
    WrenchStamped,
)
from robolink.interfaces.sensor_msgs.msg import BatteryState, JointState
from robolink.interfaces.std_msgs.msg import Float64MultiArray, Header, Int8MultiArray, String
from robolink.interfaces.trajectory_msgs.msg import JointTrajectoryPoint, MultiDOFJointTrajectoryPoint
from robolink.message import Message, Sequence, float64, int8, string, uint16


class JointTolerance(Message):
    """Tolerance of a joint's position (radians or metres), of its velocity (per second) and acceleration (per second²).

    0 leaves the controller's own limit in force; -1 removes it.
    """

    name: string
    position: float64
    velocity: float64
    acceleration: float64


class JointComponentTolerance(Message):
    """Tolerance of one component of a joint with several degrees of freedom.

    The AXIS components and TRANSLATION, the whole distance, are in metres, m/s and m/s²; ROTATION is in radians,
    rad/s and rad/s². A planar joint has no Z_AXIS.
    """

    X_AXIS: ClassVar[uint16] = 1
    Y_AXIS: ClassVar[uint16] = 2
    Z_AXIS: ClassVar[uint16] = 3
    TRANSLATION: ClassVar[uint16] = 4
    ROTATION: ClassVar[uint16] = 5

    joint_name: string
    component: uint16
    position: float64
    velocity: float64
    acceleration: float64


class JointTrajectoryControllerState(Message):
    """Present state of a joint trajectory controller.

    `reference` is where the joints should be, `feedback` where they are, `error` the first less the second and
    `output` what the hardware is told. The fields that begin with multi_dof say the same of joints with several
    degrees of freedom. `speed_scaling_factor` is 1.0 when the trajectory runs at its own speed, 0.0 when it pauses.
    """

    header: Header
    joint_names: Sequence[string]
    reference: JointTrajectoryPoint
    feedback: JointTrajectoryPoint
    error: JointTrajectoryPoint
    output: JointTrajectoryPoint
    multi_dof_joint_names: Sequence[string]
    multi_dof_reference: MultiDOFJointTrajectoryPoint
    multi_dof_feedback: MultiDOFJointTrajectoryPoint
    multi_dof_error: MultiDOFJointTrajectoryPoint
    multi_dof_output: MultiDOFJointTrajectoryPoint
    speed_scaling_factor: float64


class JointControllerState(Message):
    """Present state of a PID controller of one joint; SingleDOFStateStamped has taken its place.

    `error` is `process_value` less `set_point`, `process_value_dot` the change of the process value per second,
    `time_step` the seconds between two updates, `command` the output; p, i, d and `i_clamp` are the gains, and the
    limit of the integral.
    """

    header: Header
    set_point: float64
    process_value: float64
    process_value_dot: float64
    error: float64
    time_step: float64
    command: float64
    p: float64
    i: float64
    d: float64
    i_clamp: float64
    antiwindup: bool


class JointJog(Message):
    """Move joints a little, by hand.

    `displacements` are in radians or metres, `velocities` in rad/s or m/s, in the order of `joint_names`; both
    together ask for a motion with that speed. `duration` is in seconds.
    """

    header: Header
    joint_names: Sequence[string]
    displacements: Sequence[float64]
    velocities: Sequence[float64]
    duration: float64


class GripperCommand(Message):
    """Wanted width of a gripper's opening, in metres, and its largest force, in newtons."""

    position: float64
    max_effort: float64


class InterfaceValue(Message):
    """Values by name, such as ``position`` and ``velocity``."""

    interface_names: Sequence[string]
    values: Sequence[float64]


class DynamicJointState(Message):
    """For each joint, whatever its hardware tells: `interface_values` has one element for each of `joint_names`."""

    header: Header
    joint_names: Sequence[string]
    interface_values: Sequence[InterfaceValue]


class DynamicInterfaceValues(Message):
    """Values of hardware interfaces: what they report (`states`) and what they are told (`commands`)."""

    header: Header
    states: InterfaceValue
    commands: InterfaceValue


class DynamicInterfaceGroupValues(Message):
    """For each group of hardware interfaces, its values: one element for each of `interface_groups`."""

    header: Header
    interface_groups: Sequence[string]
    interface_values: Sequence[InterfaceValue]


class Keys(Message):
    """The names that belong to the values of a Float64Values."""

    header: Header
    keys: Sequence[string]


class Float64Values(Message):
    """Values, whose names are in a message of type Keys, in the same order."""

    header: Header
    values: Sequence[float64]


class SingleDOFState(Message):
    """Present state of a controller of one degree of freedom.

    `reference` is what should be, `feedback` what is and `feedback_dot` its change per second; `error` is the first
    less the second. `time_step` is the seconds between two updates and `output` what the hardware is told.
    """

    name: string
    reference: float64
    feedback: float64
    feedback_dot: float64
    error: float64
    error_dot: float64
    time_step: float64
    output: float64


class SingleDOFStateStamped(Message):
    """State of a controller of one degree of freedom, with its time."""

    header: Header
    dof_state: SingleDOFState


class MultiDOFStateStamped(Message):
    """State of a controller of several degrees of freedom, with its time."""

    header: Header
    dof_states: Sequence[SingleDOFState]


class MultiDOFCommand(Message):
    """Wanted values of several degrees of freedom, by name, and where wanted their change per second."""

    dof_names: Sequence[string]
    values: Sequence[float64]
    values_dot: Sequence[float64]


class PidState(Message):
    """The inside of a PID controller: its error, the error's change per second, gains and output.

    `p_error`, `i_error` and `d_error` are what the gains `p_term`, `i_term` and `d_term` are multiplied by; the
    integral is kept between `i_min` and `i_max`. `timestep` is the time between two updates.
    """

    header: Header
    timestep: Duration
    error: float64
    error_dot: float64
    p_error: float64
    i_error: float64
    d_error: float64
    p_term: float64
    i_term: float64
    d_term: float64
    i_max: float64
    i_min: float64
    output: float64


class SpeedScalingFactor(Message):
    """Speed of a trajectory as a factor: 1.0 is its own speed, 0.0 a pause; never negative."""

    factor: float64


class SteeringControllerStatus(Message):
    """The wheels of a robot that steers: positions in radians, velocities in rad/s, for each wheel.

    `traction_wheels_position` is filled when the drive is controlled by position, `traction_wheels_velocity` when by
    velocity.
    """

    header: Header
    traction_wheels_position: Sequence[float64]
    traction_wheels_velocity: Sequence[float64]
    steer_positions: Sequence[float64]
    linear_velocity_command: Sequence[float64]
    steering_angle_command: Sequence[float64]


class MecanumDriveControllerState(Message):
    """The velocity of each wheel of a mecanum drive, in rad/s, and that asked of the whole robot."""

    header: Header
    front_left_wheel_velocity: float64
    back_left_wheel_velocity: float64
    back_right_wheel_velocity: float64
    front_right_wheel_velocity: float64
    reference_velocity: Twist


class AdmittanceControllerState(Message):
    """The inside of an admittance controller, which lets a robot arm give way to forces.

    `mass`, `damping` and `stiffness` have an element for each of the six axes, `selected_axes` a 1 for those that
    give way. `rot_base_control` turns the base frame into the control frame; `ref_trans_base_ft` is where the force
    sensor is, whose frame is `ft_sensor_frame`. The rest is what was computed: how the arm gives way in space
    (`admittance_...`), the force and torque used, and the joints' offsets.
    """

    mass: Float64MultiArray
    damping: Float64MultiArray
    stiffness: Float64MultiArray
    rot_base_control: Quaternion
    ref_trans_base_ft: TransformStamped
    selected_axes: Int8MultiArray
    ft_sensor_frame: String
    admittance_position: TransformStamped
    admittance_acceleration: TwistStamped
    admittance_velocity: TwistStamped
    wrench_base: WrenchStamped
    joint_state: JointState


class BatteryStateArray(Message):
    """Several batteries."""

    battery_states: Sequence[BatteryState]


class MotionArgument(Message):
    """One more argument of a motion, such as a limit of speed, by name."""

    name: string
    value: float64


class MotionPrimitive(Message):
    """One motion of a robot arm, as a robot's own controller knows them.

    LINEAR_JOINT is straight for the joints (PTP), LINEAR_CARTESIAN straight in space (LIN), CIRCULAR_CARTESIAN an arc
    (CIRC), with a point on the way and the end. The goal is given as `poses` or as `joint_positions` in radians.
    Within `blend_radius` metres of it the arm may turn to the next motion already.
    """

    UNKNOWN: ClassVar[int8] = -1
    LINEAR_JOINT: ClassVar[int8] = 0
    LINEAR_CARTESIAN: ClassVar[int8] = 50
    CIRCULAR_CARTESIAN: ClassVar[int8] = 51

    type: int8 = -1
    blend_radius: float64
    additional_arguments: Sequence[MotionArgument]
    poses: Sequence[PoseStamped]
    joint_positions: Sequence[float64]


class MotionPrimitiveSequence(Message):
    """Motions, one after the other."""

    motions: Sequence[MotionPrimitive]


class VDA5050SafetyState(Message):
    """Safety state of an automated vehicle, after VDA 5050: the reasons why it may not drive.

    `e_stop` is how its emergency stop is released: by itself (AUTO_ACK), by hand at the vehicle (MANUAL), from afar
    (REMOTE); NONE when it has not stopped. `field_violation` is True while something is within its protective field.
    """

    AUTO_ACK: ClassVar[string] = "autoAck"
    MANUAL: ClassVar[string] = "manual"
    REMOTE: ClassVar[string] = "remote"
    NONE: ClassVar[string] = "none"

    e_stop: string
    field_violation: bool
