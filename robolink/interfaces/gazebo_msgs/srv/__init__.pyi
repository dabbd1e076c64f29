# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message
import robolink.interfaces.builtin_interfaces.msg
import robolink.interfaces.gazebo_msgs.msg
import robolink.interfaces.geometry_msgs.msg
import robolink.interfaces.std_msgs.msg
import robolink.interfaces.trajectory_msgs.msg

__all__ = ["ApplyBodyWrench", "ApplyJointEffort", "ApplyLinkWrench", "BodyRequest", "DeleteEntity", "DeleteLight", "DeleteModel", "GetEntityState", "GetJointProperties", "GetLightProperties", "GetLinkProperties", "GetLinkState", "GetModelList", "GetModelProperties", "GetModelState", "GetPhysicsProperties", "GetWorldProperties", "JointRequest", "LinkRequest", "SetEntityState", "SetJointProperties", "SetJointTrajectory", "SetLightProperties", "SetLinkProperties", "SetLinkState", "SetModelConfiguration", "SetModelState", "SetPhysicsProperties", "SpawnEntity", "SpawnModel"]

class ApplyBodyWrench(robolink.message.Service):
    """Push a body.

    The body, a point at which to push, the force (N) and torque (Nm), and from when and for how long.

    The point is in the reference frame. A negative duration is without end, a start of 0 is at once.
    """
    class Request(robolink.message.Message):
        body_name: builtins.str
        reference_frame: builtins.str
        reference_point: robolink.interfaces.geometry_msgs.msg.Point
        wrench: robolink.interfaces.geometry_msgs.msg.Wrench
        start_time: robolink.interfaces.builtin_interfaces.msg.Time
        duration: robolink.interfaces.builtin_interfaces.msg.Duration
        def __init__(self, *, body_name: builtins.str = ..., reference_frame: builtins.str = ..., reference_point: robolink.interfaces.geometry_msgs.msg.Point = ..., wrench: robolink.interfaces.geometry_msgs.msg.Wrench = ..., start_time: robolink.interfaces.builtin_interfaces.msg.Time = ..., duration: robolink.interfaces.builtin_interfaces.msg.Duration = ...) -> None: ...
    class Response(robolink.message.Message):
        """Success, and words for people, above all after a failure."""
        success: builtins.bool
        status_message: builtins.str
        def __init__(self, *, success: builtins.bool = ..., status_message: builtins.str = ...) -> None: ...
class ApplyJointEffort(robolink.message.Service):
    """Push a joint.

    The joint, the force (N) or torque (Nm), and from when and for how long.

    A negative duration is without end, a start of 0 is at once.
    """
    class Request(robolink.message.Message):
        joint_name: builtins.str
        effort: builtins.float
        start_time: robolink.interfaces.builtin_interfaces.msg.Time
        duration: robolink.interfaces.builtin_interfaces.msg.Duration
        def __init__(self, *, joint_name: builtins.str = ..., effort: builtins.float = ..., start_time: robolink.interfaces.builtin_interfaces.msg.Time = ..., duration: robolink.interfaces.builtin_interfaces.msg.Duration = ...) -> None: ...
    class Response(robolink.message.Message):
        """Success, and words for people, above all after a failure."""
        success: builtins.bool
        status_message: builtins.str
        def __init__(self, *, success: builtins.bool = ..., status_message: builtins.str = ...) -> None: ...
class ApplyLinkWrench(robolink.message.Service):
    """Push a link.

    The link, a point at which to push, the force (N) and torque (Nm), and from when and for how long.

    The point is in the reference frame. A negative duration is without end, a start of 0 is at once.
    """
    class Request(robolink.message.Message):
        link_name: builtins.str
        reference_frame: builtins.str
        reference_point: robolink.interfaces.geometry_msgs.msg.Point
        wrench: robolink.interfaces.geometry_msgs.msg.Wrench
        start_time: robolink.interfaces.builtin_interfaces.msg.Time
        duration: robolink.interfaces.builtin_interfaces.msg.Duration
        def __init__(self, *, link_name: builtins.str = ..., reference_frame: builtins.str = ..., reference_point: robolink.interfaces.geometry_msgs.msg.Point = ..., wrench: robolink.interfaces.geometry_msgs.msg.Wrench = ..., start_time: robolink.interfaces.builtin_interfaces.msg.Time = ..., duration: robolink.interfaces.builtin_interfaces.msg.Duration = ...) -> None: ...
    class Response(robolink.message.Message):
        """Success, and words for people, above all after a failure."""
        success: builtins.bool
        status_message: builtins.str
        def __init__(self, *, success: builtins.bool = ..., status_message: builtins.str = ...) -> None: ...
class BodyRequest(robolink.message.Service):
    """End the pushing of a body.

    The body, named MODEL::LINK.
    """
    class Request(robolink.message.Message):
        body_name: builtins.str
        def __init__(self, *, body_name: builtins.str = ...) -> None: ...
    class Response(robolink.message.Message):
        """Nothing."""
        def __init__(self) -> None: ...
class DeleteEntity(robolink.message.Service):
    """Remove an entity from the world.

    The entity's name.
    """
    class Request(robolink.message.Message):
        name: builtins.str
        def __init__(self, *, name: builtins.str = ...) -> None: ...
    class Response(robolink.message.Message):
        """Success, and words for people, above all after a failure."""
        success: builtins.bool
        status_message: builtins.str
        def __init__(self, *, success: builtins.bool = ..., status_message: builtins.str = ...) -> None: ...
class DeleteLight(robolink.message.Service):
    """Remove a light from the world.

    The light's name.
    """
    class Request(robolink.message.Message):
        light_name: builtins.str
        def __init__(self, *, light_name: builtins.str = ...) -> None: ...
    class Response(robolink.message.Message):
        """Success, and words for people, above all after a failure."""
        success: builtins.bool
        status_message: builtins.str
        def __init__(self, *, success: builtins.bool = ..., status_message: builtins.str = ...) -> None: ...
class DeleteModel(robolink.message.Service):
    """Remove a model from the world.

    The model's name.
    """
    class Request(robolink.message.Message):
        model_name: builtins.str
        def __init__(self, *, model_name: builtins.str = ...) -> None: ...
    class Response(robolink.message.Message):
        """Success, and words for people, above all after a failure."""
        success: builtins.bool
        status_message: builtins.str
        def __init__(self, *, success: builtins.bool = ..., status_message: builtins.str = ...) -> None: ...
class GetEntityState(robolink.message.Service):
    """Return pose and velocity of an entity.

    The entity, and the one in whose frame to express them.
    """
    class Request(robolink.message.Message):
        name: builtins.str
        reference_frame: builtins.str
        def __init__(self, *, name: builtins.str = ..., reference_frame: builtins.str = ...) -> None: ...
    class Response(robolink.message.Message):
        """The state, and whether there is such an entity."""
        header: robolink.interfaces.std_msgs.msg.Header
        state: robolink.interfaces.gazebo_msgs.msg.EntityState
        success: builtins.bool
        def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., state: robolink.interfaces.gazebo_msgs.msg.EntityState = ..., success: builtins.bool = ...) -> None: ...
class GetJointProperties(robolink.message.Service):
    """Return kind, position and velocity of a joint.

    The joint's name.
    """
    class Request(robolink.message.Message):
        joint_name: builtins.str
        def __init__(self, *, joint_name: builtins.str = ...) -> None: ...
    class Response(robolink.message.Message):
        """Kind of the joint, and for each axis damping, position (rad or m) and velocity."""
        REVOLUTE: typing.ClassVar[builtins.int]
        CONTINUOUS: typing.ClassVar[builtins.int]
        PRISMATIC: typing.ClassVar[builtins.int]
        FIXED: typing.ClassVar[builtins.int]
        BALL: typing.ClassVar[builtins.int]
        UNIVERSAL: typing.ClassVar[builtins.int]
        type: builtins.int
        damping: collections.abc.MutableSequence[builtins.float]
        position: collections.abc.MutableSequence[builtins.float]
        rate: collections.abc.MutableSequence[builtins.float]
        success: builtins.bool
        status_message: builtins.str
        def __init__(self, *, type: builtins.int = ..., damping: collections.abc.Iterable[builtins.float] = ..., position: collections.abc.Iterable[builtins.float] = ..., rate: collections.abc.Iterable[builtins.float] = ..., success: builtins.bool = ..., status_message: builtins.str = ...) -> None: ...
class GetLightProperties(robolink.message.Service):
    """Return a light's colour and range.

    The light's name.
    """
    class Request(robolink.message.Message):
        light_name: builtins.str
        def __init__(self, *, light_name: builtins.str = ...) -> None: ...
    class Response(robolink.message.Message):
        """Colour, and the three terms by which the light fades with distance."""
        diffuse: robolink.interfaces.std_msgs.msg.ColorRGBA
        attenuation_constant: builtins.float
        attenuation_linear: builtins.float
        attenuation_quadratic: builtins.float
        success: builtins.bool
        status_message: builtins.str
        def __init__(self, *, diffuse: robolink.interfaces.std_msgs.msg.ColorRGBA = ..., attenuation_constant: builtins.float = ..., attenuation_linear: builtins.float = ..., attenuation_quadratic: builtins.float = ..., success: builtins.bool = ..., status_message: builtins.str = ...) -> None: ...
class GetLinkProperties(robolink.message.Service):
    """Return mass and inertia of a link.

    The link's name.
    """
    class Request(robolink.message.Message):
        link_name: builtins.str
        def __init__(self, *, link_name: builtins.str = ...) -> None: ...
    class Response(robolink.message.Message):
        """Centre of mass, mass in kg and moments of inertia in kg m²; `gravity_mode` True lets gravity pull."""
        com: robolink.interfaces.geometry_msgs.msg.Pose
        gravity_mode: builtins.bool
        mass: builtins.float
        ixx: builtins.float
        ixy: builtins.float
        ixz: builtins.float
        iyy: builtins.float
        iyz: builtins.float
        izz: builtins.float
        success: builtins.bool
        status_message: builtins.str
        def __init__(self, *, com: robolink.interfaces.geometry_msgs.msg.Pose = ..., gravity_mode: builtins.bool = ..., mass: builtins.float = ..., ixx: builtins.float = ..., ixy: builtins.float = ..., ixz: builtins.float = ..., iyy: builtins.float = ..., iyz: builtins.float = ..., izz: builtins.float = ..., success: builtins.bool = ..., status_message: builtins.str = ...) -> None: ...
class GetLinkState(robolink.message.Service):
    """Return pose and velocity of a link.

    The link, and the one in whose frame to express them.
    """
    class Request(robolink.message.Message):
        link_name: builtins.str
        reference_frame: builtins.str
        def __init__(self, *, link_name: builtins.str = ..., reference_frame: builtins.str = ...) -> None: ...
    class Response(robolink.message.Message):
        """The state, or no success and why."""
        link_state: robolink.interfaces.gazebo_msgs.msg.LinkState
        success: builtins.bool
        status_message: builtins.str
        def __init__(self, *, link_state: robolink.interfaces.gazebo_msgs.msg.LinkState = ..., success: builtins.bool = ..., status_message: builtins.str = ...) -> None: ...
class GetModelList(robolink.message.Service):
    """Return the names of all models.

    Nothing.
    """
    class Request(robolink.message.Message):
        def __init__(self) -> None: ...
    class Response(robolink.message.Message):
        """The names."""
        header: robolink.interfaces.std_msgs.msg.Header
        model_names: collections.abc.MutableSequence[builtins.str]
        success: builtins.bool
        def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., model_names: collections.abc.Iterable[builtins.str] = ..., success: builtins.bool = ...) -> None: ...
class GetModelProperties(robolink.message.Service):
    """Return the parts of a model.

    The model's name.
    """
    class Request(robolink.message.Message):
        model_name: builtins.str
        def __init__(self, *, model_name: builtins.str = ...) -> None: ...
    class Response(robolink.message.Message):
        """Parent, links, shapes, joints and children, and whether the model cannot move."""
        parent_model_name: builtins.str
        canonical_body_name: builtins.str
        body_names: collections.abc.MutableSequence[builtins.str]
        geom_names: collections.abc.MutableSequence[builtins.str]
        joint_names: collections.abc.MutableSequence[builtins.str]
        child_model_names: collections.abc.MutableSequence[builtins.str]
        is_static: builtins.bool
        success: builtins.bool
        status_message: builtins.str
        def __init__(self, *, parent_model_name: builtins.str = ..., canonical_body_name: builtins.str = ..., body_names: collections.abc.Iterable[builtins.str] = ..., geom_names: collections.abc.Iterable[builtins.str] = ..., joint_names: collections.abc.Iterable[builtins.str] = ..., child_model_names: collections.abc.Iterable[builtins.str] = ..., is_static: builtins.bool = ..., success: builtins.bool = ..., status_message: builtins.str = ...) -> None: ...
class GetModelState(robolink.message.Service):
    """Return pose and velocity of a model.

    The model, and the entity in whose frame to express them.
    """
    class Request(robolink.message.Message):
        model_name: builtins.str
        relative_entity_name: builtins.str
        def __init__(self, *, model_name: builtins.str = ..., relative_entity_name: builtins.str = ...) -> None: ...
    class Response(robolink.message.Message):
        """The state, and whether there is such a model; if not, why."""
        header: robolink.interfaces.std_msgs.msg.Header
        pose: robolink.interfaces.geometry_msgs.msg.Pose
        twist: robolink.interfaces.geometry_msgs.msg.Twist
        success: builtins.bool
        status_message: builtins.str
        def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., pose: robolink.interfaces.geometry_msgs.msg.Pose = ..., twist: robolink.interfaces.geometry_msgs.msg.Twist = ..., success: builtins.bool = ..., status_message: builtins.str = ...) -> None: ...
class GetPhysicsProperties(robolink.message.Service):
    """Return the settings of the physics.

    Nothing.
    """
    class Request(robolink.message.Message):
        def __init__(self) -> None: ...
    class Response(robolink.message.Message):
        """Step in seconds, steps in a second at most, gravity in m/s², and the engine's settings."""
        time_step: builtins.float
        pause: builtins.bool
        max_update_rate: builtins.float
        gravity: robolink.interfaces.geometry_msgs.msg.Vector3
        ode_config: robolink.interfaces.gazebo_msgs.msg.ODEPhysics
        success: builtins.bool
        status_message: builtins.str
        def __init__(self, *, time_step: builtins.float = ..., pause: builtins.bool = ..., max_update_rate: builtins.float = ..., gravity: robolink.interfaces.geometry_msgs.msg.Vector3 = ..., ode_config: robolink.interfaces.gazebo_msgs.msg.ODEPhysics = ..., success: builtins.bool = ..., status_message: builtins.str = ...) -> None: ...
class GetWorldProperties(robolink.message.Service):
    """Return time and models of the world.

    Nothing.
    """
    class Request(robolink.message.Message):
        def __init__(self) -> None: ...
    class Response(robolink.message.Message):
        """Simulated time in seconds, the models' names, and whether pictures are drawn."""
        sim_time: builtins.float
        model_names: collections.abc.MutableSequence[builtins.str]
        rendering_enabled: builtins.bool
        success: builtins.bool
        status_message: builtins.str
        def __init__(self, *, sim_time: builtins.float = ..., model_names: collections.abc.Iterable[builtins.str] = ..., rendering_enabled: builtins.bool = ..., success: builtins.bool = ..., status_message: builtins.str = ...) -> None: ...
class JointRequest(robolink.message.Service):
    """End the pushing of a joint.

    The joint's name.
    """
    class Request(robolink.message.Message):
        joint_name: builtins.str
        def __init__(self, *, joint_name: builtins.str = ...) -> None: ...
    class Response(robolink.message.Message):
        """Nothing."""
        def __init__(self) -> None: ...
class LinkRequest(robolink.message.Service):
    """End the pushing of a link.

    The link, named MODEL::LINK.
    """
    class Request(robolink.message.Message):
        link_name: builtins.str
        def __init__(self, *, link_name: builtins.str = ...) -> None: ...
    class Response(robolink.message.Message):
        """Nothing."""
        def __init__(self) -> None: ...
class SetEntityState(robolink.message.Service):
    """Move an entity.

    The new state.
    """
    class Request(robolink.message.Message):
        state: robolink.interfaces.gazebo_msgs.msg.EntityState
        def __init__(self, *, state: robolink.interfaces.gazebo_msgs.msg.EntityState = ...) -> None: ...
    class Response(robolink.message.Message):
        """Success."""
        success: builtins.bool
        def __init__(self, *, success: builtins.bool = ...) -> None: ...
class SetJointProperties(robolink.message.Service):
    """Set how the physics engine treats a joint.

    The joint and its settings.
    """
    class Request(robolink.message.Message):
        joint_name: builtins.str
        ode_joint_config: robolink.interfaces.gazebo_msgs.msg.ODEJointProperties
        def __init__(self, *, joint_name: builtins.str = ..., ode_joint_config: robolink.interfaces.gazebo_msgs.msg.ODEJointProperties = ...) -> None: ...
    class Response(robolink.message.Message):
        """Success, and words for people, above all after a failure."""
        success: builtins.bool
        status_message: builtins.str
        def __init__(self, *, success: builtins.bool = ..., status_message: builtins.str = ...) -> None: ...
class SetJointTrajectory(robolink.message.Service):
    """Move a model's joints along a trajectory, without physics.

    The trajectory; with `set_model_pose` the model is put to a pose first.
    """
    class Request(robolink.message.Message):
        model_name: builtins.str
        joint_trajectory: robolink.interfaces.trajectory_msgs.msg.JointTrajectory
        model_pose: robolink.interfaces.geometry_msgs.msg.Pose
        set_model_pose: builtins.bool
        disable_physics_updates: builtins.bool
        def __init__(self, *, model_name: builtins.str = ..., joint_trajectory: robolink.interfaces.trajectory_msgs.msg.JointTrajectory = ..., model_pose: robolink.interfaces.geometry_msgs.msg.Pose = ..., set_model_pose: builtins.bool = ..., disable_physics_updates: builtins.bool = ...) -> None: ...
    class Response(robolink.message.Message):
        """Success, and words for people, above all after a failure."""
        success: builtins.bool
        status_message: builtins.str
        def __init__(self, *, success: builtins.bool = ..., status_message: builtins.str = ...) -> None: ...
class SetLightProperties(robolink.message.Service):
    """Set a light's colour and range.

    Colour, and the three terms by which the light fades with distance.
    """
    class Request(robolink.message.Message):
        light_name: builtins.str
        diffuse: robolink.interfaces.std_msgs.msg.ColorRGBA
        attenuation_constant: builtins.float
        attenuation_linear: builtins.float
        attenuation_quadratic: builtins.float
        def __init__(self, *, light_name: builtins.str = ..., diffuse: robolink.interfaces.std_msgs.msg.ColorRGBA = ..., attenuation_constant: builtins.float = ..., attenuation_linear: builtins.float = ..., attenuation_quadratic: builtins.float = ...) -> None: ...
    class Response(robolink.message.Message):
        """Success, and words for people, above all after a failure."""
        success: builtins.bool
        status_message: builtins.str
        def __init__(self, *, success: builtins.bool = ..., status_message: builtins.str = ...) -> None: ...
class SetLinkProperties(robolink.message.Service):
    """Set mass and inertia of a link.

    Centre of mass, mass in kg and moments of inertia in kg m²; `gravity_mode` True lets gravity pull.
    """
    class Request(robolink.message.Message):
        link_name: builtins.str
        com: robolink.interfaces.geometry_msgs.msg.Pose
        gravity_mode: builtins.bool
        mass: builtins.float
        ixx: builtins.float
        ixy: builtins.float
        ixz: builtins.float
        iyy: builtins.float
        iyz: builtins.float
        izz: builtins.float
        def __init__(self, *, link_name: builtins.str = ..., com: robolink.interfaces.geometry_msgs.msg.Pose = ..., gravity_mode: builtins.bool = ..., mass: builtins.float = ..., ixx: builtins.float = ..., ixy: builtins.float = ..., ixz: builtins.float = ..., iyy: builtins.float = ..., iyz: builtins.float = ..., izz: builtins.float = ...) -> None: ...
    class Response(robolink.message.Message):
        """Success, and words for people, above all after a failure."""
        success: builtins.bool
        status_message: builtins.str
        def __init__(self, *, success: builtins.bool = ..., status_message: builtins.str = ...) -> None: ...
class SetLinkState(robolink.message.Service):
    """Move a link.

    The new state.
    """
    class Request(robolink.message.Message):
        link_state: robolink.interfaces.gazebo_msgs.msg.LinkState
        def __init__(self, *, link_state: robolink.interfaces.gazebo_msgs.msg.LinkState = ...) -> None: ...
    class Response(robolink.message.Message):
        """Success, and words for people, above all after a failure."""
        success: builtins.bool
        status_message: builtins.str
        def __init__(self, *, success: builtins.bool = ..., status_message: builtins.str = ...) -> None: ...
class SetModelConfiguration(robolink.message.Service):
    """Set the positions of a model's joints.

    The model, names of joints and their positions in radians or metres; other joints stay as they are.
    """
    class Request(robolink.message.Message):
        model_name: builtins.str
        urdf_param_name: builtins.str
        joint_names: collections.abc.MutableSequence[builtins.str]
        joint_positions: collections.abc.MutableSequence[builtins.float]
        def __init__(self, *, model_name: builtins.str = ..., urdf_param_name: builtins.str = ..., joint_names: collections.abc.Iterable[builtins.str] = ..., joint_positions: collections.abc.Iterable[builtins.float] = ...) -> None: ...
    class Response(robolink.message.Message):
        """Success, and words for people, above all after a failure."""
        success: builtins.bool
        status_message: builtins.str
        def __init__(self, *, success: builtins.bool = ..., status_message: builtins.str = ...) -> None: ...
class SetModelState(robolink.message.Service):
    """Move a model.

    The new state.
    """
    class Request(robolink.message.Message):
        model_state: robolink.interfaces.gazebo_msgs.msg.ModelState
        def __init__(self, *, model_state: robolink.interfaces.gazebo_msgs.msg.ModelState = ...) -> None: ...
    class Response(robolink.message.Message):
        """Success, and words for people, above all after a failure."""
        success: builtins.bool
        status_message: builtins.str
        def __init__(self, *, success: builtins.bool = ..., status_message: builtins.str = ...) -> None: ...
class SetPhysicsProperties(robolink.message.Service):
    """Set the settings of the physics.

    Step in seconds, steps in a second at most, gravity in m/s², and the engine's settings.
    """
    class Request(robolink.message.Message):
        time_step: builtins.float
        max_update_rate: builtins.float
        gravity: robolink.interfaces.geometry_msgs.msg.Vector3
        ode_config: robolink.interfaces.gazebo_msgs.msg.ODEPhysics
        def __init__(self, *, time_step: builtins.float = ..., max_update_rate: builtins.float = ..., gravity: robolink.interfaces.geometry_msgs.msg.Vector3 = ..., ode_config: robolink.interfaces.gazebo_msgs.msg.ODEPhysics = ...) -> None: ...
    class Response(robolink.message.Message):
        """Success, and words for people, above all after a failure."""
        success: builtins.bool
        status_message: builtins.str
        def __init__(self, *, success: builtins.bool = ..., status_message: builtins.str = ...) -> None: ...
class SpawnEntity(robolink.message.Service):
    """Add an entity to the world.

    Name, description in URDF or SDF, namespace for its ROS plugins, and pose in the frame of another entity.
    """
    class Request(robolink.message.Message):
        name: builtins.str
        xml: builtins.str
        robot_namespace: builtins.str
        initial_pose: robolink.interfaces.geometry_msgs.msg.Pose
        reference_frame: builtins.str
        def __init__(self, *, name: builtins.str = ..., xml: builtins.str = ..., robot_namespace: builtins.str = ..., initial_pose: robolink.interfaces.geometry_msgs.msg.Pose = ..., reference_frame: builtins.str = ...) -> None: ...
    class Response(robolink.message.Message):
        """Success, and words for people, above all after a failure."""
        success: builtins.bool
        status_message: builtins.str
        def __init__(self, *, success: builtins.bool = ..., status_message: builtins.str = ...) -> None: ...
class SpawnModel(robolink.message.Service):
    """Add a model to the world.

    Name, description in URDF or SDF, namespace for its ROS plugins, and pose in the frame of another entity.
    """
    class Request(robolink.message.Message):
        model_name: builtins.str
        model_xml: builtins.str
        robot_namespace: builtins.str
        initial_pose: robolink.interfaces.geometry_msgs.msg.Pose
        reference_frame: builtins.str
        def __init__(self, *, model_name: builtins.str = ..., model_xml: builtins.str = ..., robot_namespace: builtins.str = ..., initial_pose: robolink.interfaces.geometry_msgs.msg.Pose = ..., reference_frame: builtins.str = ...) -> None: ...
    class Response(robolink.message.Message):
        """Success, and words for people, above all after a failure."""
        success: builtins.bool
        status_message: builtins.str
        def __init__(self, *, success: builtins.bool = ..., status_message: builtins.str = ...) -> None: ...
