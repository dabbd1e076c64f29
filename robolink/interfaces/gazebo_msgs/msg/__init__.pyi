# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message
import robolink.interfaces.gazebo_msgs.msg
import robolink.interfaces.geometry_msgs.msg
import robolink.interfaces.std_msgs.msg

__all__ = ["ContactState", "ContactsState", "EntityState", "LinkState", "LinkStates", "ModelState", "ModelStates", "ODEJointProperties", "ODEPhysics", "PerformanceMetrics", "SensorPerformanceMetric", "WheelSlip", "WorldState"]

class ContactState(robolink.message.Message):
    """A contact of two shapes, with forces (N), torques (Nm), points, normals, and depths in metres."""
    info: builtins.str
    collision1_name: builtins.str
    collision2_name: builtins.str
    wrenches: collections.abc.MutableSequence[robolink.interfaces.geometry_msgs.msg.Wrench]
    total_wrench: robolink.interfaces.geometry_msgs.msg.Wrench
    contact_positions: collections.abc.MutableSequence[robolink.interfaces.geometry_msgs.msg.Vector3]
    contact_normals: collections.abc.MutableSequence[robolink.interfaces.geometry_msgs.msg.Vector3]
    depths: collections.abc.MutableSequence[builtins.float]
    def __init__(self, *, info: builtins.str = ..., collision1_name: builtins.str = ..., collision2_name: builtins.str = ..., wrenches: collections.abc.Iterable[robolink.interfaces.geometry_msgs.msg.Wrench] = ..., total_wrench: robolink.interfaces.geometry_msgs.msg.Wrench = ..., contact_positions: collections.abc.Iterable[robolink.interfaces.geometry_msgs.msg.Vector3] = ..., contact_normals: collections.abc.Iterable[robolink.interfaces.geometry_msgs.msg.Vector3] = ..., depths: collections.abc.Iterable[builtins.float] = ...) -> None: ...
class ContactsState(robolink.message.Message):
    """The contacts of a sensor."""
    header: robolink.interfaces.std_msgs.msg.Header
    states: collections.abc.MutableSequence[robolink.interfaces.gazebo_msgs.msg.ContactState]
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., states: collections.abc.Iterable[robolink.interfaces.gazebo_msgs.msg.ContactState] = ...) -> None: ...
class EntityState(robolink.message.Message):
    """Pose and velocity of an entity in the frame of another; an empty frame is the world."""
    name: builtins.str
    pose: robolink.interfaces.geometry_msgs.msg.Pose
    twist: robolink.interfaces.geometry_msgs.msg.Twist
    reference_frame: builtins.str
    def __init__(self, *, name: builtins.str = ..., pose: robolink.interfaces.geometry_msgs.msg.Pose = ..., twist: robolink.interfaces.geometry_msgs.msg.Twist = ..., reference_frame: builtins.str = ...) -> None: ...
class LinkState(robolink.message.Message):
    """Pose and velocity of a link, named MODEL::LINK, in the frame of another link; an empty frame is the world."""
    link_name: builtins.str
    pose: robolink.interfaces.geometry_msgs.msg.Pose
    twist: robolink.interfaces.geometry_msgs.msg.Twist
    reference_frame: builtins.str
    def __init__(self, *, link_name: builtins.str = ..., pose: robolink.interfaces.geometry_msgs.msg.Pose = ..., twist: robolink.interfaces.geometry_msgs.msg.Twist = ..., reference_frame: builtins.str = ...) -> None: ...
class LinkStates(robolink.message.Message):
    """Names, poses and velocities of all links in the world's frame."""
    name: collections.abc.MutableSequence[builtins.str]
    pose: collections.abc.MutableSequence[robolink.interfaces.geometry_msgs.msg.Pose]
    twist: collections.abc.MutableSequence[robolink.interfaces.geometry_msgs.msg.Twist]
    def __init__(self, *, name: collections.abc.Iterable[builtins.str] = ..., pose: collections.abc.Iterable[robolink.interfaces.geometry_msgs.msg.Pose] = ..., twist: collections.abc.Iterable[robolink.interfaces.geometry_msgs.msg.Twist] = ...) -> None: ...
class ModelState(robolink.message.Message):
    """Pose and velocity of a model in the frame of another entity; an empty frame is the world."""
    model_name: builtins.str
    pose: robolink.interfaces.geometry_msgs.msg.Pose
    twist: robolink.interfaces.geometry_msgs.msg.Twist
    reference_frame: builtins.str
    def __init__(self, *, model_name: builtins.str = ..., pose: robolink.interfaces.geometry_msgs.msg.Pose = ..., twist: robolink.interfaces.geometry_msgs.msg.Twist = ..., reference_frame: builtins.str = ...) -> None: ...
class ModelStates(robolink.message.Message):
    """Names, poses and velocities of all models in the world's frame."""
    name: collections.abc.MutableSequence[builtins.str]
    pose: collections.abc.MutableSequence[robolink.interfaces.geometry_msgs.msg.Pose]
    twist: collections.abc.MutableSequence[robolink.interfaces.geometry_msgs.msg.Twist]
    def __init__(self, *, name: collections.abc.Iterable[builtins.str] = ..., pose: collections.abc.Iterable[robolink.interfaces.geometry_msgs.msg.Pose] = ..., twist: collections.abc.Iterable[robolink.interfaces.geometry_msgs.msg.Twist] = ...) -> None: ...
class ODEJointProperties(robolink.message.Message):
    """Settings of a joint in the ODE physics engine, one value for each axis.

    Damping, limits, error reduction (erp), softness (cfm), greatest force and speed of the motor.
    """
    damping: collections.abc.MutableSequence[builtins.float]
    hi_stop: collections.abc.MutableSequence[builtins.float]
    lo_stop: collections.abc.MutableSequence[builtins.float]
    erp: collections.abc.MutableSequence[builtins.float]
    cfm: collections.abc.MutableSequence[builtins.float]
    stop_erp: collections.abc.MutableSequence[builtins.float]
    stop_cfm: collections.abc.MutableSequence[builtins.float]
    fudge_factor: collections.abc.MutableSequence[builtins.float]
    fmax: collections.abc.MutableSequence[builtins.float]
    vel: collections.abc.MutableSequence[builtins.float]
    def __init__(self, *, damping: collections.abc.Iterable[builtins.float] = ..., hi_stop: collections.abc.Iterable[builtins.float] = ..., lo_stop: collections.abc.Iterable[builtins.float] = ..., erp: collections.abc.Iterable[builtins.float] = ..., cfm: collections.abc.Iterable[builtins.float] = ..., stop_erp: collections.abc.Iterable[builtins.float] = ..., stop_cfm: collections.abc.Iterable[builtins.float] = ..., fudge_factor: collections.abc.Iterable[builtins.float] = ..., fmax: collections.abc.Iterable[builtins.float] = ..., vel: collections.abc.Iterable[builtins.float] = ...) -> None: ...
class ODEPhysics(robolink.message.Message):
    """Settings of the ODE physics engine: iterations and tolerance of its solver, and how contacts are corrected."""
    auto_disable_bodies: builtins.bool
    sor_pgs_precon_iters: builtins.int
    sor_pgs_iters: builtins.int
    sor_pgs_w: builtins.float
    sor_pgs_rms_error_tol: builtins.float
    contact_surface_layer: builtins.float
    contact_max_correcting_vel: builtins.float
    cfm: builtins.float
    erp: builtins.float
    max_contacts: builtins.int
    def __init__(self, *, auto_disable_bodies: builtins.bool = ..., sor_pgs_precon_iters: builtins.int = ..., sor_pgs_iters: builtins.int = ..., sor_pgs_w: builtins.float = ..., sor_pgs_rms_error_tol: builtins.float = ..., contact_surface_layer: builtins.float = ..., contact_max_correcting_vel: builtins.float = ..., cfm: builtins.float = ..., erp: builtins.float = ..., max_contacts: builtins.int = ...) -> None: ...
class PerformanceMetrics(robolink.message.Message):
    """Speed of the simulation: simulated seconds in a real one, and the rates of the sensors."""
    header: robolink.interfaces.std_msgs.msg.Header
    real_time_factor: builtins.float
    sensors: collections.abc.MutableSequence[robolink.interfaces.gazebo_msgs.msg.SensorPerformanceMetric]
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., real_time_factor: builtins.float = ..., sensors: collections.abc.Iterable[robolink.interfaces.gazebo_msgs.msg.SensorPerformanceMetric] = ...) -> None: ...
class SensorPerformanceMetric(robolink.message.Message):
    """Rates of a sensor in Hz: in simulated time, in real time, and, of a camera, its frames."""
    name: builtins.str
    sim_update_rate: builtins.float
    real_update_rate: builtins.float
    fps: builtins.float
    def __init__(self, *, name: builtins.str = ..., sim_update_rate: builtins.float = ..., real_update_rate: builtins.float = ..., fps: builtins.float = ...) -> None: ...
class WheelSlip(robolink.message.Message):
    """Names of wheels, and how far they slip sideways and along, in m/s."""
    name: collections.abc.MutableSequence[builtins.str]
    lateral_slip: collections.abc.MutableSequence[builtins.float]
    longitudinal_slip: collections.abc.MutableSequence[builtins.float]
    def __init__(self, *, name: collections.abc.Iterable[builtins.str] = ..., lateral_slip: collections.abc.Iterable[builtins.float] = ..., longitudinal_slip: collections.abc.Iterable[builtins.float] = ...) -> None: ...
class WorldState(robolink.message.Message):
    """Names, poses, velocities and forces of all that is in the world."""
    header: robolink.interfaces.std_msgs.msg.Header
    name: collections.abc.MutableSequence[builtins.str]
    pose: collections.abc.MutableSequence[robolink.interfaces.geometry_msgs.msg.Pose]
    twist: collections.abc.MutableSequence[robolink.interfaces.geometry_msgs.msg.Twist]
    wrench: collections.abc.MutableSequence[robolink.interfaces.geometry_msgs.msg.Wrench]
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., name: collections.abc.Iterable[builtins.str] = ..., pose: collections.abc.Iterable[robolink.interfaces.geometry_msgs.msg.Pose] = ..., twist: collections.abc.Iterable[robolink.interfaces.geometry_msgs.msg.Twist] = ..., wrench: collections.abc.Iterable[robolink.interfaces.geometry_msgs.msg.Wrench] = ...) -> None: ...
