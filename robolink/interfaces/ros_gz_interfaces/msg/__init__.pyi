# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message
import robolink.interfaces.builtin_interfaces.msg
import robolink.interfaces.geometry_msgs.msg
import robolink.interfaces.rcl_interfaces.msg
import robolink.interfaces.ros_gz_interfaces.msg
import robolink.interfaces.std_msgs.msg

__all__ = ["Altimeter", "Contact", "Contacts", "Dataframe", "Entity", "EntityFactory", "EntityWrench", "Float32Array", "GuiCamera", "JointWrench", "Light", "MaterialColor", "ParamVec", "SensorNoise", "StringVec", "TrackVisual", "VideoRecord", "WorldControl", "WorldReset"]

class Altimeter(robolink.message.Message):
    """Height in metres and speed upwards in m/s, relative to `vertical_reference`."""
    header: robolink.interfaces.std_msgs.msg.Header
    vertical_position: builtins.float
    vertical_velocity: builtins.float
    vertical_reference: builtins.float
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., vertical_position: builtins.float = ..., vertical_velocity: builtins.float = ..., vertical_reference: builtins.float = ...) -> None: ...
class Contact(robolink.message.Message):
    """A contact of two shapes, with points, normals, depths in metres, and forces."""
    collision1: robolink.interfaces.ros_gz_interfaces.msg.Entity
    collision2: robolink.interfaces.ros_gz_interfaces.msg.Entity
    positions: collections.abc.MutableSequence[robolink.interfaces.geometry_msgs.msg.Vector3]
    normals: collections.abc.MutableSequence[robolink.interfaces.geometry_msgs.msg.Vector3]
    depths: collections.abc.MutableSequence[builtins.float]
    wrenches: collections.abc.MutableSequence[robolink.interfaces.ros_gz_interfaces.msg.JointWrench]
    def __init__(self, *, collision1: robolink.interfaces.ros_gz_interfaces.msg.Entity = ..., collision2: robolink.interfaces.ros_gz_interfaces.msg.Entity = ..., positions: collections.abc.Iterable[robolink.interfaces.geometry_msgs.msg.Vector3] = ..., normals: collections.abc.Iterable[robolink.interfaces.geometry_msgs.msg.Vector3] = ..., depths: collections.abc.Iterable[builtins.float] = ..., wrenches: collections.abc.Iterable[robolink.interfaces.ros_gz_interfaces.msg.JointWrench] = ...) -> None: ...
class Contacts(robolink.message.Message):
    """The contacts of a sensor."""
    header: robolink.interfaces.std_msgs.msg.Header
    contacts: collections.abc.MutableSequence[robolink.interfaces.ros_gz_interfaces.msg.Contact]
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., contacts: collections.abc.Iterable[robolink.interfaces.ros_gz_interfaces.msg.Contact] = ...) -> None: ...
class Dataframe(robolink.message.Message):
    """A packet of a simulated radio: sender, receiver, strength of the signal in dBm, and content."""
    header: robolink.interfaces.std_msgs.msg.Header
    src_address: builtins.str
    dst_address: builtins.str
    data: collections.abc.MutableSequence[builtins.int]
    rssi: builtins.float
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., src_address: builtins.str = ..., dst_address: builtins.str = ..., data: collections.abc.Iterable[builtins.int] = ..., rssi: builtins.float = ...) -> None: ...
class Entity(robolink.message.Message):
    """Something in the world, by number or by name, and its kind. A number of 0 stands for the name."""
    NONE: typing.ClassVar[builtins.int]
    LIGHT: typing.ClassVar[builtins.int]
    MODEL: typing.ClassVar[builtins.int]
    LINK: typing.ClassVar[builtins.int]
    VISUAL: typing.ClassVar[builtins.int]
    COLLISION: typing.ClassVar[builtins.int]
    SENSOR: typing.ClassVar[builtins.int]
    JOINT: typing.ClassVar[builtins.int]
    id: builtins.int
    name: builtins.str
    type: builtins.int
    def __init__(self, *, id: builtins.int = ..., name: builtins.str = ..., type: builtins.int = ...) -> None: ...
class EntityFactory(robolink.message.Message):
    """A new entity: its name, its description as SDF (text, file or a copy of another), and its pose."""
    name: builtins.str
    allow_renaming: builtins.bool
    sdf: builtins.str
    sdf_filename: builtins.str
    clone_name: builtins.str
    pose: robolink.interfaces.geometry_msgs.msg.Pose
    relative_to: builtins.str
    def __init__(self, *, name: builtins.str = ..., allow_renaming: builtins.bool = ..., sdf: builtins.str = ..., sdf_filename: builtins.str = ..., clone_name: builtins.str = ..., pose: robolink.interfaces.geometry_msgs.msg.Pose = ..., relative_to: builtins.str = ...) -> None: ...
class EntityWrench(robolink.message.Message):
    """Force and torque on an entity."""
    header: robolink.interfaces.std_msgs.msg.Header
    entity: robolink.interfaces.ros_gz_interfaces.msg.Entity
    wrench: robolink.interfaces.geometry_msgs.msg.Wrench
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., entity: robolink.interfaces.ros_gz_interfaces.msg.Entity = ..., wrench: robolink.interfaces.geometry_msgs.msg.Wrench = ...) -> None: ...
class Float32Array(robolink.message.Message):
    """Numbers."""
    data: collections.abc.MutableSequence[builtins.float]
    def __init__(self, *, data: collections.abc.Iterable[builtins.float] = ...) -> None: ...
class GuiCamera(robolink.message.Message):
    """Camera of the window: its pose, its projection, and what it follows."""
    header: robolink.interfaces.std_msgs.msg.Header
    name: builtins.str
    view_controller: builtins.str
    pose: robolink.interfaces.geometry_msgs.msg.Pose
    track: robolink.interfaces.ros_gz_interfaces.msg.TrackVisual
    projection_type: builtins.str
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., name: builtins.str = ..., view_controller: builtins.str = ..., pose: robolink.interfaces.geometry_msgs.msg.Pose = ..., track: robolink.interfaces.ros_gz_interfaces.msg.TrackVisual = ..., projection_type: builtins.str = ...) -> None: ...
class JointWrench(robolink.message.Message):
    """Forces and torques between two bodies."""
    header: robolink.interfaces.std_msgs.msg.Header
    body_1_name: robolink.interfaces.std_msgs.msg.String
    body_1_id: robolink.interfaces.std_msgs.msg.UInt32
    body_2_name: robolink.interfaces.std_msgs.msg.String
    body_2_id: robolink.interfaces.std_msgs.msg.UInt32
    body_1_wrench: robolink.interfaces.geometry_msgs.msg.Wrench
    body_2_wrench: robolink.interfaces.geometry_msgs.msg.Wrench
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., body_1_name: robolink.interfaces.std_msgs.msg.String = ..., body_1_id: robolink.interfaces.std_msgs.msg.UInt32 = ..., body_2_name: robolink.interfaces.std_msgs.msg.String = ..., body_2_id: robolink.interfaces.std_msgs.msg.UInt32 = ..., body_1_wrench: robolink.interfaces.geometry_msgs.msg.Wrench = ..., body_2_wrench: robolink.interfaces.geometry_msgs.msg.Wrench = ...) -> None: ...
class Light(robolink.message.Message):
    """A light: its kind, pose and colours, its range in metres, how it fades, and the angles of its cone."""
    POINT: typing.ClassVar[builtins.int]
    SPOT: typing.ClassVar[builtins.int]
    DIRECTIONAL: typing.ClassVar[builtins.int]
    header: robolink.interfaces.std_msgs.msg.Header
    name: builtins.str
    type: builtins.int
    pose: robolink.interfaces.geometry_msgs.msg.Pose
    diffuse: robolink.interfaces.std_msgs.msg.ColorRGBA
    specular: robolink.interfaces.std_msgs.msg.ColorRGBA
    attenuation_constant: builtins.float
    attenuation_linear: builtins.float
    attenuation_quadratic: builtins.float
    direction: robolink.interfaces.geometry_msgs.msg.Vector3
    range: builtins.float
    cast_shadows: builtins.bool
    spot_inner_angle: builtins.float
    spot_outer_angle: builtins.float
    spot_falloff: builtins.float
    id: builtins.int
    parent_id: builtins.int
    intensity: builtins.float
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., name: builtins.str = ..., type: builtins.int = ..., pose: robolink.interfaces.geometry_msgs.msg.Pose = ..., diffuse: robolink.interfaces.std_msgs.msg.ColorRGBA = ..., specular: robolink.interfaces.std_msgs.msg.ColorRGBA = ..., attenuation_constant: builtins.float = ..., attenuation_linear: builtins.float = ..., attenuation_quadratic: builtins.float = ..., direction: robolink.interfaces.geometry_msgs.msg.Vector3 = ..., range: builtins.float = ..., cast_shadows: builtins.bool = ..., spot_inner_angle: builtins.float = ..., spot_outer_angle: builtins.float = ..., spot_falloff: builtins.float = ..., id: builtins.int = ..., parent_id: builtins.int = ..., intensity: builtins.float = ...) -> None: ...
class MaterialColor(robolink.message.Message):
    """Colours for the first entity that fits, or for all."""
    FIRST: typing.ClassVar[builtins.int]
    ALL: typing.ClassVar[builtins.int]
    header: robolink.interfaces.std_msgs.msg.Header
    entity: robolink.interfaces.ros_gz_interfaces.msg.Entity
    ambient: robolink.interfaces.std_msgs.msg.ColorRGBA
    diffuse: robolink.interfaces.std_msgs.msg.ColorRGBA
    specular: robolink.interfaces.std_msgs.msg.ColorRGBA
    emissive: robolink.interfaces.std_msgs.msg.ColorRGBA
    shininess: builtins.float
    entity_match: builtins.int
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., entity: robolink.interfaces.ros_gz_interfaces.msg.Entity = ..., ambient: robolink.interfaces.std_msgs.msg.ColorRGBA = ..., diffuse: robolink.interfaces.std_msgs.msg.ColorRGBA = ..., specular: robolink.interfaces.std_msgs.msg.ColorRGBA = ..., emissive: robolink.interfaces.std_msgs.msg.ColorRGBA = ..., shininess: builtins.float = ..., entity_match: builtins.int = ...) -> None: ...
class ParamVec(robolink.message.Message):
    """Parameters."""
    header: robolink.interfaces.std_msgs.msg.Header
    params: collections.abc.MutableSequence[robolink.interfaces.rcl_interfaces.msg.Parameter]
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., params: collections.abc.Iterable[robolink.interfaces.rcl_interfaces.msg.Parameter] = ...) -> None: ...
class SensorNoise(robolink.message.Message):
    """Noise of a sensor: its kind, mean, deviation, bias, and how the bias drifts."""
    NONE: typing.ClassVar[builtins.int]
    GAUSSIAN: typing.ClassVar[builtins.int]
    GAUSSIAN_QUANTIZED: typing.ClassVar[builtins.int]
    header: robolink.interfaces.std_msgs.msg.Header
    type: builtins.int
    mean: builtins.float
    stddev: builtins.float
    bias_mean: builtins.float
    bias_stddev: builtins.float
    precision: builtins.float
    dynamic_bias_stddev: builtins.float
    dynamic_bias_correlation_time: builtins.float
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., type: builtins.int = ..., mean: builtins.float = ..., stddev: builtins.float = ..., bias_mean: builtins.float = ..., bias_stddev: builtins.float = ..., precision: builtins.float = ..., dynamic_bias_stddev: builtins.float = ..., dynamic_bias_correlation_time: builtins.float = ...) -> None: ...
class StringVec(robolink.message.Message):
    """Texts."""
    header: robolink.interfaces.std_msgs.msg.Header
    data: collections.abc.MutableSequence[builtins.str]
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., data: collections.abc.Iterable[builtins.str] = ...) -> None: ...
class TrackVisual(robolink.message.Message):
    """Something for the camera of the window to follow: from which distances in metres, and how."""
    header: robolink.interfaces.std_msgs.msg.Header
    name: builtins.str
    id: builtins.int
    inherit_orientation: builtins.bool
    min_dist: builtins.float
    max_dist: builtins.float
    is_static: builtins.bool
    use_model_frame: builtins.bool
    xyz: robolink.interfaces.geometry_msgs.msg.Vector3
    inherit_yaw: builtins.bool
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., name: builtins.str = ..., id: builtins.int = ..., inherit_orientation: builtins.bool = ..., min_dist: builtins.float = ..., max_dist: builtins.float = ..., is_static: builtins.bool = ..., use_model_frame: builtins.bool = ..., xyz: robolink.interfaces.geometry_msgs.msg.Vector3 = ..., inherit_yaw: builtins.bool = ...) -> None: ...
class VideoRecord(robolink.message.Message):
    """Recording of the window to start or to stop."""
    header: robolink.interfaces.std_msgs.msg.Header
    start: builtins.bool
    stop: builtins.bool
    format: builtins.str
    save_filename: builtins.str
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., start: builtins.bool = ..., stop: builtins.bool = ..., format: builtins.str = ..., save_filename: builtins.str = ...) -> None: ...
class WorldControl(robolink.message.Message):
    """Order to the simulation: pause, steps, reset, seed, or a time to run to."""
    pause: builtins.bool
    step: builtins.bool
    multi_step: builtins.int
    reset: robolink.interfaces.ros_gz_interfaces.msg.WorldReset
    seed: builtins.int
    run_to_sim_time: robolink.interfaces.builtin_interfaces.msg.Time
    def __init__(self, *, pause: builtins.bool = ..., step: builtins.bool = ..., multi_step: builtins.int = ..., reset: robolink.interfaces.ros_gz_interfaces.msg.WorldReset = ..., seed: builtins.int = ..., run_to_sim_time: robolink.interfaces.builtin_interfaces.msg.Time = ...) -> None: ...
class WorldReset(robolink.message.Message):
    """Parts of the world to reset: all, only the time, or only the models."""
    all: builtins.bool
    time_only: builtins.bool
    model_only: builtins.bool
    def __init__(self, *, all: builtins.bool = ..., time_only: builtins.bool = ..., model_only: builtins.bool = ...) -> None: ...
