# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message
import robolink.interfaces.builtin_interfaces.msg
import robolink.interfaces.control_msgs.msg
import robolink.interfaces.geometry_msgs.msg
import robolink.interfaces.sensor_msgs.msg
import robolink.interfaces.std_msgs.msg
import robolink.interfaces.trajectory_msgs.msg

__all__ = ["AdmittanceControllerState", "BatteryStateArray", "DynamicInterfaceGroupValues", "DynamicInterfaceValues", "DynamicJointState", "Float64Values", "GripperCommand", "InterfaceValue", "JointComponentTolerance", "JointControllerState", "JointJog", "JointTolerance", "JointTrajectoryControllerState", "Keys", "MecanumDriveControllerState", "MotionArgument", "MotionPrimitive", "MotionPrimitiveSequence", "MultiDOFCommand", "MultiDOFStateStamped", "PidState", "SingleDOFState", "SingleDOFStateStamped", "SpeedScalingFactor", "SteeringControllerStatus", "VDA5050SafetyState"]

class AdmittanceControllerState(robolink.message.Message):
    """The inside of an admittance controller, which lets a robot arm give way to forces.

    `mass`, `damping` and `stiffness` have an element for each of the six axes, `selected_axes` a 1 for those that
    give way. `rot_base_control` turns the base frame into the control frame; `ref_trans_base_ft` is where the force
    sensor is, whose frame is `ft_sensor_frame`. The rest is what was computed: how the arm gives way in space
    (`admittance_...`), the force and torque used, and the joints' offsets.
    """
    mass: robolink.interfaces.std_msgs.msg.Float64MultiArray
    damping: robolink.interfaces.std_msgs.msg.Float64MultiArray
    stiffness: robolink.interfaces.std_msgs.msg.Float64MultiArray
    rot_base_control: robolink.interfaces.geometry_msgs.msg.Quaternion
    ref_trans_base_ft: robolink.interfaces.geometry_msgs.msg.TransformStamped
    selected_axes: robolink.interfaces.std_msgs.msg.Int8MultiArray
    ft_sensor_frame: robolink.interfaces.std_msgs.msg.String
    admittance_position: robolink.interfaces.geometry_msgs.msg.TransformStamped
    admittance_acceleration: robolink.interfaces.geometry_msgs.msg.TwistStamped
    admittance_velocity: robolink.interfaces.geometry_msgs.msg.TwistStamped
    wrench_base: robolink.interfaces.geometry_msgs.msg.WrenchStamped
    joint_state: robolink.interfaces.sensor_msgs.msg.JointState
    def __init__(self, *, mass: robolink.interfaces.std_msgs.msg.Float64MultiArray = ..., damping: robolink.interfaces.std_msgs.msg.Float64MultiArray = ..., stiffness: robolink.interfaces.std_msgs.msg.Float64MultiArray = ..., rot_base_control: robolink.interfaces.geometry_msgs.msg.Quaternion = ..., ref_trans_base_ft: robolink.interfaces.geometry_msgs.msg.TransformStamped = ..., selected_axes: robolink.interfaces.std_msgs.msg.Int8MultiArray = ..., ft_sensor_frame: robolink.interfaces.std_msgs.msg.String = ..., admittance_position: robolink.interfaces.geometry_msgs.msg.TransformStamped = ..., admittance_acceleration: robolink.interfaces.geometry_msgs.msg.TwistStamped = ..., admittance_velocity: robolink.interfaces.geometry_msgs.msg.TwistStamped = ..., wrench_base: robolink.interfaces.geometry_msgs.msg.WrenchStamped = ..., joint_state: robolink.interfaces.sensor_msgs.msg.JointState = ...) -> None: ...
class BatteryStateArray(robolink.message.Message):
    """Several batteries."""
    battery_states: collections.abc.MutableSequence[robolink.interfaces.sensor_msgs.msg.BatteryState]
    def __init__(self, *, battery_states: collections.abc.Iterable[robolink.interfaces.sensor_msgs.msg.BatteryState] = ...) -> None: ...
class DynamicInterfaceGroupValues(robolink.message.Message):
    """For each group of hardware interfaces, its values: one element for each of `interface_groups`."""
    header: robolink.interfaces.std_msgs.msg.Header
    interface_groups: collections.abc.MutableSequence[builtins.str]
    interface_values: collections.abc.MutableSequence[robolink.interfaces.control_msgs.msg.InterfaceValue]
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., interface_groups: collections.abc.Iterable[builtins.str] = ..., interface_values: collections.abc.Iterable[robolink.interfaces.control_msgs.msg.InterfaceValue] = ...) -> None: ...
class DynamicInterfaceValues(robolink.message.Message):
    """Values of hardware interfaces: what they report (`states`) and what they are told (`commands`)."""
    header: robolink.interfaces.std_msgs.msg.Header
    states: robolink.interfaces.control_msgs.msg.InterfaceValue
    commands: robolink.interfaces.control_msgs.msg.InterfaceValue
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., states: robolink.interfaces.control_msgs.msg.InterfaceValue = ..., commands: robolink.interfaces.control_msgs.msg.InterfaceValue = ...) -> None: ...
class DynamicJointState(robolink.message.Message):
    """For each joint, whatever its hardware tells: `interface_values` has one element for each of `joint_names`."""
    header: robolink.interfaces.std_msgs.msg.Header
    joint_names: collections.abc.MutableSequence[builtins.str]
    interface_values: collections.abc.MutableSequence[robolink.interfaces.control_msgs.msg.InterfaceValue]
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., joint_names: collections.abc.Iterable[builtins.str] = ..., interface_values: collections.abc.Iterable[robolink.interfaces.control_msgs.msg.InterfaceValue] = ...) -> None: ...
class Float64Values(robolink.message.Message):
    """Values, whose names are in a message of type Keys, in the same order."""
    header: robolink.interfaces.std_msgs.msg.Header
    values: collections.abc.MutableSequence[builtins.float]
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., values: collections.abc.Iterable[builtins.float] = ...) -> None: ...
class GripperCommand(robolink.message.Message):
    """Wanted width of a gripper's opening, in metres, and its largest force, in newtons."""
    position: builtins.float
    max_effort: builtins.float
    def __init__(self, *, position: builtins.float = ..., max_effort: builtins.float = ...) -> None: ...
class InterfaceValue(robolink.message.Message):
    """Values by name, such as ``position`` and ``velocity``."""
    interface_names: collections.abc.MutableSequence[builtins.str]
    values: collections.abc.MutableSequence[builtins.float]
    def __init__(self, *, interface_names: collections.abc.Iterable[builtins.str] = ..., values: collections.abc.Iterable[builtins.float] = ...) -> None: ...
class JointComponentTolerance(robolink.message.Message):
    """Tolerance of one component of a joint with several degrees of freedom.

    The AXIS components and TRANSLATION, the whole distance, are in metres, m/s and m/s²; ROTATION is in radians,
    rad/s and rad/s². A planar joint has no Z_AXIS.
    """
    X_AXIS: typing.ClassVar[builtins.int]
    Y_AXIS: typing.ClassVar[builtins.int]
    Z_AXIS: typing.ClassVar[builtins.int]
    TRANSLATION: typing.ClassVar[builtins.int]
    ROTATION: typing.ClassVar[builtins.int]
    joint_name: builtins.str
    component: builtins.int
    position: builtins.float
    velocity: builtins.float
    acceleration: builtins.float
    def __init__(self, *, joint_name: builtins.str = ..., component: builtins.int = ..., position: builtins.float = ..., velocity: builtins.float = ..., acceleration: builtins.float = ...) -> None: ...
class JointControllerState(robolink.message.Message):
    """Present state of a PID controller of one joint; SingleDOFStateStamped has taken its place.

    `error` is `process_value` less `set_point`, `process_value_dot` the change of the process value per second,
    `time_step` the seconds between two updates, `command` the output; p, i, d and `i_clamp` are the gains, and the
    limit of the integral.
    """
    header: robolink.interfaces.std_msgs.msg.Header
    set_point: builtins.float
    process_value: builtins.float
    process_value_dot: builtins.float
    error: builtins.float
    time_step: builtins.float
    command: builtins.float
    p: builtins.float
    i: builtins.float
    d: builtins.float
    i_clamp: builtins.float
    antiwindup: builtins.bool
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., set_point: builtins.float = ..., process_value: builtins.float = ..., process_value_dot: builtins.float = ..., error: builtins.float = ..., time_step: builtins.float = ..., command: builtins.float = ..., p: builtins.float = ..., i: builtins.float = ..., d: builtins.float = ..., i_clamp: builtins.float = ..., antiwindup: builtins.bool = ...) -> None: ...
class JointJog(robolink.message.Message):
    """Move joints a little, by hand.

    `displacements` are in radians or metres, `velocities` in rad/s or m/s, in the order of `joint_names`; both
    together ask for a motion with that speed. `duration` is in seconds.
    """
    header: robolink.interfaces.std_msgs.msg.Header
    joint_names: collections.abc.MutableSequence[builtins.str]
    displacements: collections.abc.MutableSequence[builtins.float]
    velocities: collections.abc.MutableSequence[builtins.float]
    duration: builtins.float
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., joint_names: collections.abc.Iterable[builtins.str] = ..., displacements: collections.abc.Iterable[builtins.float] = ..., velocities: collections.abc.Iterable[builtins.float] = ..., duration: builtins.float = ...) -> None: ...
class JointTolerance(robolink.message.Message):
    """Tolerance of a joint's position (radians or metres), of its velocity (per second) and acceleration (per second²).

    0 leaves the controller's own limit in force; -1 removes it.
    """
    name: builtins.str
    position: builtins.float
    velocity: builtins.float
    acceleration: builtins.float
    def __init__(self, *, name: builtins.str = ..., position: builtins.float = ..., velocity: builtins.float = ..., acceleration: builtins.float = ...) -> None: ...
class JointTrajectoryControllerState(robolink.message.Message):
    """Present state of a joint trajectory controller.

    `reference` is where the joints should be, `feedback` where they are, `error` the first less the second and
    `output` what the hardware is told. The fields that begin with multi_dof say the same of joints with several
    degrees of freedom. `speed_scaling_factor` is 1.0 when the trajectory runs at its own speed, 0.0 when it pauses.
    """
    header: robolink.interfaces.std_msgs.msg.Header
    joint_names: collections.abc.MutableSequence[builtins.str]
    reference: robolink.interfaces.trajectory_msgs.msg.JointTrajectoryPoint
    feedback: robolink.interfaces.trajectory_msgs.msg.JointTrajectoryPoint
    error: robolink.interfaces.trajectory_msgs.msg.JointTrajectoryPoint
    output: robolink.interfaces.trajectory_msgs.msg.JointTrajectoryPoint
    multi_dof_joint_names: collections.abc.MutableSequence[builtins.str]
    multi_dof_reference: robolink.interfaces.trajectory_msgs.msg.MultiDOFJointTrajectoryPoint
    multi_dof_feedback: robolink.interfaces.trajectory_msgs.msg.MultiDOFJointTrajectoryPoint
    multi_dof_error: robolink.interfaces.trajectory_msgs.msg.MultiDOFJointTrajectoryPoint
    multi_dof_output: robolink.interfaces.trajectory_msgs.msg.MultiDOFJointTrajectoryPoint
    speed_scaling_factor: builtins.float
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., joint_names: collections.abc.Iterable[builtins.str] = ..., reference: robolink.interfaces.trajectory_msgs.msg.JointTrajectoryPoint = ..., feedback: robolink.interfaces.trajectory_msgs.msg.JointTrajectoryPoint = ..., error: robolink.interfaces.trajectory_msgs.msg.JointTrajectoryPoint = ..., output: robolink.interfaces.trajectory_msgs.msg.JointTrajectoryPoint = ..., multi_dof_joint_names: collections.abc.Iterable[builtins.str] = ..., multi_dof_reference: robolink.interfaces.trajectory_msgs.msg.MultiDOFJointTrajectoryPoint = ..., multi_dof_feedback: robolink.interfaces.trajectory_msgs.msg.MultiDOFJointTrajectoryPoint = ..., multi_dof_error: robolink.interfaces.trajectory_msgs.msg.MultiDOFJointTrajectoryPoint = ..., multi_dof_output: robolink.interfaces.trajectory_msgs.msg.MultiDOFJointTrajectoryPoint = ..., speed_scaling_factor: builtins.float = ...) -> None: ...
class Keys(robolink.message.Message):
    """The names that belong to the values of a Float64Values."""
    header: robolink.interfaces.std_msgs.msg.Header
    keys: collections.abc.MutableSequence[builtins.str]
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., keys: collections.abc.Iterable[builtins.str] = ...) -> None: ...
class MecanumDriveControllerState(robolink.message.Message):
    """The velocity of each wheel of a mecanum drive, in rad/s, and that asked of the whole robot."""
    header: robolink.interfaces.std_msgs.msg.Header
    front_left_wheel_velocity: builtins.float
    back_left_wheel_velocity: builtins.float
    back_right_wheel_velocity: builtins.float
    front_right_wheel_velocity: builtins.float
    reference_velocity: robolink.interfaces.geometry_msgs.msg.Twist
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., front_left_wheel_velocity: builtins.float = ..., back_left_wheel_velocity: builtins.float = ..., back_right_wheel_velocity: builtins.float = ..., front_right_wheel_velocity: builtins.float = ..., reference_velocity: robolink.interfaces.geometry_msgs.msg.Twist = ...) -> None: ...
class MotionArgument(robolink.message.Message):
    """One more argument of a motion, such as a limit of speed, by name."""
    name: builtins.str
    value: builtins.float
    def __init__(self, *, name: builtins.str = ..., value: builtins.float = ...) -> None: ...
class MotionPrimitive(robolink.message.Message):
    """One motion of a robot arm, as a robot's own controller knows them.

    LINEAR_JOINT is straight for the joints (PTP), LINEAR_CARTESIAN straight in space (LIN), CIRCULAR_CARTESIAN an arc
    (CIRC), with a point on the way and the end. The goal is given as `poses` or as `joint_positions` in radians.
    Within `blend_radius` metres of it the arm may turn to the next motion already.
    """
    UNKNOWN: typing.ClassVar[builtins.int]
    LINEAR_JOINT: typing.ClassVar[builtins.int]
    LINEAR_CARTESIAN: typing.ClassVar[builtins.int]
    CIRCULAR_CARTESIAN: typing.ClassVar[builtins.int]
    type: builtins.int
    blend_radius: builtins.float
    additional_arguments: collections.abc.MutableSequence[robolink.interfaces.control_msgs.msg.MotionArgument]
    poses: collections.abc.MutableSequence[robolink.interfaces.geometry_msgs.msg.PoseStamped]
    joint_positions: collections.abc.MutableSequence[builtins.float]
    def __init__(self, *, type: builtins.int = ..., blend_radius: builtins.float = ..., additional_arguments: collections.abc.Iterable[robolink.interfaces.control_msgs.msg.MotionArgument] = ..., poses: collections.abc.Iterable[robolink.interfaces.geometry_msgs.msg.PoseStamped] = ..., joint_positions: collections.abc.Iterable[builtins.float] = ...) -> None: ...
class MotionPrimitiveSequence(robolink.message.Message):
    """Motions, one after the other."""
    motions: collections.abc.MutableSequence[robolink.interfaces.control_msgs.msg.MotionPrimitive]
    def __init__(self, *, motions: collections.abc.Iterable[robolink.interfaces.control_msgs.msg.MotionPrimitive] = ...) -> None: ...
class MultiDOFCommand(robolink.message.Message):
    """Wanted values of several degrees of freedom, by name, and where wanted their change per second."""
    dof_names: collections.abc.MutableSequence[builtins.str]
    values: collections.abc.MutableSequence[builtins.float]
    values_dot: collections.abc.MutableSequence[builtins.float]
    def __init__(self, *, dof_names: collections.abc.Iterable[builtins.str] = ..., values: collections.abc.Iterable[builtins.float] = ..., values_dot: collections.abc.Iterable[builtins.float] = ...) -> None: ...
class MultiDOFStateStamped(robolink.message.Message):
    """State of a controller of several degrees of freedom, with its time."""
    header: robolink.interfaces.std_msgs.msg.Header
    dof_states: collections.abc.MutableSequence[robolink.interfaces.control_msgs.msg.SingleDOFState]
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., dof_states: collections.abc.Iterable[robolink.interfaces.control_msgs.msg.SingleDOFState] = ...) -> None: ...
class PidState(robolink.message.Message):
    """The inside of a PID controller: its error, the error's change per second, gains and output.

    `p_error`, `i_error` and `d_error` are what the gains `p_term`, `i_term` and `d_term` are multiplied by; the
    integral is kept between `i_min` and `i_max`. `timestep` is the time between two updates.
    """
    header: robolink.interfaces.std_msgs.msg.Header
    timestep: robolink.interfaces.builtin_interfaces.msg.Duration
    error: builtins.float
    error_dot: builtins.float
    p_error: builtins.float
    i_error: builtins.float
    d_error: builtins.float
    p_term: builtins.float
    i_term: builtins.float
    d_term: builtins.float
    i_max: builtins.float
    i_min: builtins.float
    output: builtins.float
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., timestep: robolink.interfaces.builtin_interfaces.msg.Duration = ..., error: builtins.float = ..., error_dot: builtins.float = ..., p_error: builtins.float = ..., i_error: builtins.float = ..., d_error: builtins.float = ..., p_term: builtins.float = ..., i_term: builtins.float = ..., d_term: builtins.float = ..., i_max: builtins.float = ..., i_min: builtins.float = ..., output: builtins.float = ...) -> None: ...
class SingleDOFState(robolink.message.Message):
    """Present state of a controller of one degree of freedom.

    `reference` is what should be, `feedback` what is and `feedback_dot` its change per second; `error` is the first
    less the second. `time_step` is the seconds between two updates and `output` what the hardware is told.
    """
    name: builtins.str
    reference: builtins.float
    feedback: builtins.float
    feedback_dot: builtins.float
    error: builtins.float
    error_dot: builtins.float
    time_step: builtins.float
    output: builtins.float
    def __init__(self, *, name: builtins.str = ..., reference: builtins.float = ..., feedback: builtins.float = ..., feedback_dot: builtins.float = ..., error: builtins.float = ..., error_dot: builtins.float = ..., time_step: builtins.float = ..., output: builtins.float = ...) -> None: ...
class SingleDOFStateStamped(robolink.message.Message):
    """State of a controller of one degree of freedom, with its time."""
    header: robolink.interfaces.std_msgs.msg.Header
    dof_state: robolink.interfaces.control_msgs.msg.SingleDOFState
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., dof_state: robolink.interfaces.control_msgs.msg.SingleDOFState = ...) -> None: ...
class SpeedScalingFactor(robolink.message.Message):
    """Speed of a trajectory as a factor: 1.0 is its own speed, 0.0 a pause; never negative."""
    factor: builtins.float
    def __init__(self, *, factor: builtins.float = ...) -> None: ...
class SteeringControllerStatus(robolink.message.Message):
    """The wheels of a robot that steers: positions in radians, velocities in rad/s, for each wheel.

    `traction_wheels_position` is filled when the drive is controlled by position, `traction_wheels_velocity` when by
    velocity.
    """
    header: robolink.interfaces.std_msgs.msg.Header
    traction_wheels_position: collections.abc.MutableSequence[builtins.float]
    traction_wheels_velocity: collections.abc.MutableSequence[builtins.float]
    steer_positions: collections.abc.MutableSequence[builtins.float]
    linear_velocity_command: collections.abc.MutableSequence[builtins.float]
    steering_angle_command: collections.abc.MutableSequence[builtins.float]
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., traction_wheels_position: collections.abc.Iterable[builtins.float] = ..., traction_wheels_velocity: collections.abc.Iterable[builtins.float] = ..., steer_positions: collections.abc.Iterable[builtins.float] = ..., linear_velocity_command: collections.abc.Iterable[builtins.float] = ..., steering_angle_command: collections.abc.Iterable[builtins.float] = ...) -> None: ...
class VDA5050SafetyState(robolink.message.Message):
    """Safety state of an automated vehicle, after VDA 5050: the reasons why it may not drive.

    `e_stop` is how its emergency stop is released: by itself (AUTO_ACK), by hand at the vehicle (MANUAL), from afar
    (REMOTE); NONE when it has not stopped. `field_violation` is True while something is within its protective field.
    """
    AUTO_ACK: typing.ClassVar[builtins.str]
    MANUAL: typing.ClassVar[builtins.str]
    REMOTE: typing.ClassVar[builtins.str]
    NONE: typing.ClassVar[builtins.str]
    e_stop: builtins.str
    field_violation: builtins.bool
    def __init__(self, *, e_stop: builtins.str = ..., field_violation: builtins.bool = ...) -> None: ...
