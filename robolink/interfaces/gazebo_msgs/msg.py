"""The messages of gazebo_msgs: states of entities, contacts, and settings of the physics."""

from robolink.interfaces.geometry_msgs.msg import Pose, Twist, Vector3, Wrench
from robolink.interfaces.std_msgs.msg import Header
from robolink.message import Message, Sequence, float64, string, uint32


class ContactState(Message):
    """A contact of two shapes, with forces (N), torques (Nm), points, normals, and depths in metres."""

    info: string
    collision1_name: string
    collision2_name: string
    wrenches: Sequence[Wrench]
    total_wrench: Wrench
    contact_positions: Sequence[Vector3]
    contact_normals: Sequence[Vector3]
    depths: Sequence[float64]


class ContactsState(Message):
    """The contacts of a sensor."""

    header: Header
    states: Sequence[ContactState]


class EntityState(Message):
    """Pose and velocity of an entity in the frame of another; an empty frame is the world."""

    name: string
    pose: Pose
    twist: Twist
    reference_frame: string


class LinkState(Message):
    """Pose and velocity of a link, named MODEL::LINK, in the frame of another link; an empty frame is the world."""

    link_name: string
    pose: Pose
    twist: Twist
    reference_frame: string


class LinkStates(Message):
    """Names, poses and velocities of all links in the world's frame."""

    name: Sequence[string]
    pose: Sequence[Pose]
    twist: Sequence[Twist]


class ModelState(Message):
    """Pose and velocity of a model in the frame of another entity; an empty frame is the world."""

    model_name: string
    pose: Pose
    twist: Twist
    reference_frame: string


class ModelStates(Message):
    """Names, poses and velocities of all models in the world's frame."""

    name: Sequence[string]
    pose: Sequence[Pose]
    twist: Sequence[Twist]


class ODEJointProperties(Message):
    """Settings of a joint in the ODE physics engine, one value for each axis.

    Damping, limits, error reduction (erp), softness (cfm), greatest force and speed of the motor.
    """

    damping: Sequence[float64]
    hi_stop: Sequence[float64]
    lo_stop: Sequence[float64]
    erp: Sequence[float64]
    cfm: Sequence[float64]
    stop_erp: Sequence[float64]
    stop_cfm: Sequence[float64]
    fudge_factor: Sequence[float64]
    fmax: Sequence[float64]
    vel: Sequence[float64]


class ODEPhysics(Message):
    """Settings of the ODE physics engine: iterations and tolerance of its solver, and how contacts are corrected."""

    auto_disable_bodies: bool
    sor_pgs_precon_iters: uint32
    sor_pgs_iters: uint32
    sor_pgs_w: float64
    sor_pgs_rms_error_tol: float64
    contact_surface_layer: float64
    contact_max_correcting_vel: float64
    cfm: float64
    erp: float64
    max_contacts: uint32


class SensorPerformanceMetric(Message):
    """Rates of a sensor in Hz: in simulated time, in real time, and, of a camera, its frames."""

    name: string
    sim_update_rate: float64
    real_update_rate: float64
    fps: float64


class PerformanceMetrics(Message):
    """Speed of the simulation: simulated seconds in a real one, and the rates of the sensors."""

    header: Header
    real_time_factor: float64
    sensors: Sequence[SensorPerformanceMetric]


class WheelSlip(Message):
    """Names of wheels, and how far they slip sideways and along, in m/s."""

    name: Sequence[string]
    lateral_slip: Sequence[float64]
    longitudinal_slip: Sequence[float64]


class WorldState(Message):
    """Names, poses, velocities and forces of all that is in the world."""

    header: Header
    name: Sequence[string]
    pose: Sequence[Pose]
    twist: Sequence[Twist]
    wrench: Sequence[Wrench]
