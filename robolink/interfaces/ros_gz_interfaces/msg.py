"""The messages of ros_gz_interfaces: what Gazebo has, measures and is told."""

from typing import ClassVar

from robolink.interfaces.builtin_interfaces.msg import Time
from robolink.interfaces.geometry_msgs.msg import Pose, Vector3, Wrench
from robolink.interfaces.rcl_interfaces.msg import Parameter
from robolink.interfaces.std_msgs.msg import ColorRGBA, Header, String, UInt32
from robolink.message import Message, Sequence, float32, float64, string, uint8, uint32, uint64


class Entity(Message):
    """Something in the world, by number or by name, and its kind. A number of 0 stands for the name."""

    NONE: ClassVar[uint8] = 0
    LIGHT: ClassVar[uint8] = 1
    MODEL: ClassVar[uint8] = 2
    LINK: ClassVar[uint8] = 3
    VISUAL: ClassVar[uint8] = 4
    COLLISION: ClassVar[uint8] = 5
    SENSOR: ClassVar[uint8] = 6
    JOINT: ClassVar[uint8] = 7

    id: uint64
    name: string
    type: uint8


class Altimeter(Message):
    """Height in metres and speed upwards in m/s, relative to `vertical_reference`."""

    header: Header
    vertical_position: float64
    vertical_velocity: float64
    vertical_reference: float64


class JointWrench(Message):
    """Forces and torques between two bodies."""

    header: Header
    body_1_name: String
    body_1_id: UInt32
    body_2_name: String
    body_2_id: UInt32
    body_1_wrench: Wrench
    body_2_wrench: Wrench


class Contact(Message):
    """A contact of two shapes, with points, normals, depths in metres, and forces."""

    collision1: Entity
    collision2: Entity
    positions: Sequence[Vector3]
    normals: Sequence[Vector3]
    depths: Sequence[float64]
    wrenches: Sequence[JointWrench]


class Contacts(Message):
    """The contacts of a sensor."""

    header: Header
    contacts: Sequence[Contact]


class Dataframe(Message):
    """A packet of a simulated radio: sender, receiver, strength of the signal in dBm, and content."""

    header: Header
    src_address: string
    dst_address: string
    data: Sequence[uint8]
    rssi: float64


class EntityFactory(Message):
    """A new entity: its name, its description as SDF (text, file or a copy of another), and its pose."""

    name: string
    allow_renaming: bool = False
    sdf: string
    sdf_filename: string
    clone_name: string
    pose: Pose
    relative_to: string = "world"


class EntityWrench(Message):
    """Force and torque on an entity."""

    header: Header
    entity: Entity
    wrench: Wrench


class Float32Array(Message):
    """Numbers."""

    data: Sequence[float32]


class TrackVisual(Message):
    """Something for the camera of the window to follow: from which distances in metres, and how."""

    header: Header
    name: string
    id: uint32
    inherit_orientation: bool
    min_dist: float64
    max_dist: float64
    is_static: bool
    use_model_frame: bool
    xyz: Vector3
    inherit_yaw: bool


class GuiCamera(Message):
    """Camera of the window: its pose, its projection, and what it follows."""

    header: Header
    name: string
    view_controller: string
    pose: Pose
    track: TrackVisual
    projection_type: string


class Light(Message):
    """A light: its kind, pose and colours, its range in metres, how it fades, and the angles of its cone."""

    POINT: ClassVar[uint8] = 0
    SPOT: ClassVar[uint8] = 1
    DIRECTIONAL: ClassVar[uint8] = 2

    header: Header
    name: string
    type: uint8
    pose: Pose
    diffuse: ColorRGBA
    specular: ColorRGBA
    attenuation_constant: float32
    attenuation_linear: float32
    attenuation_quadratic: float32
    direction: Vector3
    range: float32
    cast_shadows: bool
    spot_inner_angle: float32
    spot_outer_angle: float32
    spot_falloff: float32
    id: uint32
    parent_id: uint32
    intensity: float32


class MaterialColor(Message):
    """Colours for the first entity that fits, or for all."""

    FIRST: ClassVar[uint8] = 0
    ALL: ClassVar[uint8] = 1

    header: Header
    entity: Entity
    ambient: ColorRGBA
    diffuse: ColorRGBA
    specular: ColorRGBA
    emissive: ColorRGBA
    shininess: float64
    entity_match: uint8


class ParamVec(Message):
    """Parameters."""

    header: Header
    params: Sequence[Parameter]


class SensorNoise(Message):
    """Noise of a sensor: its kind, mean, deviation, bias, and how the bias drifts."""

    NONE: ClassVar[uint8] = 0
    GAUSSIAN: ClassVar[uint8] = 2
    GAUSSIAN_QUANTIZED: ClassVar[uint8] = 3

    header: Header
    type: uint8
    mean: float64
    stddev: float64
    bias_mean: float64
    bias_stddev: float64
    precision: float64
    dynamic_bias_stddev: float64
    dynamic_bias_correlation_time: float64


class StringVec(Message):
    """Texts."""

    header: Header
    data: Sequence[string]


class VideoRecord(Message):
    """Recording of the window to start or to stop."""

    header: Header
    start: bool
    stop: bool
    format: string
    save_filename: string


class WorldReset(Message):
    """Parts of the world to reset: all, only the time, or only the models."""

    all: bool = False
    time_only: bool = False
    model_only: bool = False


class WorldControl(Message):
    """Order to the simulation: pause, steps, reset, seed, or a time to run to."""

    pause: bool
    step: bool
    multi_step: uint32 = 0
    reset: WorldReset
    seed: uint32
    run_to_sim_time: Time
