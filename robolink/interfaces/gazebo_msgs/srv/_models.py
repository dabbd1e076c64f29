"""Models and other entities: adding, removing, reading and moving them."""

from robolink.interfaces.gazebo_msgs.msg import EntityState, ModelState
from robolink.interfaces.geometry_msgs.msg import Pose, Twist
from robolink.interfaces.std_msgs.msg import Header
from robolink.interfaces.trajectory_msgs.msg import JointTrajectory
from robolink.message import Message, Sequence, Service, float64, string


class SpawnEntity(Service):
    """Add an entity to the world."""

    class Request(Message):
        """Name, description in URDF or SDF, namespace for its ROS plugins, and pose in the frame of another entity."""

        name: string
        xml: string
        robot_namespace: string
        initial_pose: Pose
        reference_frame: string

    class Response(Message):
        """Success, and words for people, above all after a failure."""

        success: bool
        status_message: string


class SpawnModel(Service):
    """Add a model to the world."""

    class Request(Message):
        """Name, description in URDF or SDF, namespace for its ROS plugins, and pose in the frame of another entity."""

        model_name: string
        model_xml: string
        robot_namespace: string
        initial_pose: Pose
        reference_frame: string

    class Response(Message):
        """Success, and words for people, above all after a failure."""

        success: bool
        status_message: string


class DeleteEntity(Service):
    """Remove an entity from the world."""

    class Request(Message):
        """The entity's name."""

        name: string

    class Response(Message):
        """Success, and words for people, above all after a failure."""

        success: bool
        status_message: string


class DeleteModel(Service):
    """Remove a model from the world."""

    class Request(Message):
        """The model's name."""

        model_name: string

    class Response(Message):
        """Success, and words for people, above all after a failure."""

        success: bool
        status_message: string


class GetEntityState(Service):
    """Return pose and velocity of an entity."""

    class Request(Message):
        """The entity, and the one in whose frame to express them."""

        name: string
        reference_frame: string

    class Response(Message):
        """The state, and whether there is such an entity."""

        header: Header
        state: EntityState
        success: bool


class SetEntityState(Service):
    """Move an entity."""

    class Request(Message):
        """The new state."""

        state: EntityState

    class Response(Message):
        """Success."""

        success: bool


class GetModelState(Service):
    """Return pose and velocity of a model."""

    class Request(Message):
        """The model, and the entity in whose frame to express them."""

        model_name: string
        relative_entity_name: string

    class Response(Message):
        """The state, and whether there is such a model; if not, why."""

        header: Header
        pose: Pose
        twist: Twist
        success: bool
        status_message: string


class SetModelState(Service):
    """Move a model."""

    class Request(Message):
        """The new state."""

        model_state: ModelState

    class Response(Message):
        """Success, and words for people, above all after a failure."""

        success: bool
        status_message: string


class GetModelList(Service):
    """Return the names of all models."""

    class Request(Message):
        """Nothing."""

    class Response(Message):
        """The names."""

        header: Header
        model_names: Sequence[string]
        success: bool


class GetModelProperties(Service):
    """Return the parts of a model."""

    class Request(Message):
        """The model's name."""

        model_name: string

    class Response(Message):
        """Parent, links, shapes, joints and children, and whether the model cannot move."""

        parent_model_name: string
        canonical_body_name: string
        body_names: Sequence[string]
        geom_names: Sequence[string]
        joint_names: Sequence[string]
        child_model_names: Sequence[string]
        is_static: bool
        success: bool
        status_message: string


class SetModelConfiguration(Service):
    """Set the positions of a model's joints."""

    class Request(Message):
        """The model, names of joints and their positions in radians or metres; other joints stay as they are."""

        model_name: string
        urdf_param_name: string
        joint_names: Sequence[string]
        joint_positions: Sequence[float64]

    class Response(Message):
        """Success, and words for people, above all after a failure."""

        success: bool
        status_message: string


class SetJointTrajectory(Service):
    """Move a model's joints along a trajectory, without physics."""

    class Request(Message):
        """The trajectory; with `set_model_pose` the model is put to a pose first."""

        model_name: string
        joint_trajectory: JointTrajectory
        model_pose: Pose
        set_model_pose: bool
        disable_physics_updates: bool

    class Response(Message):
        """Success, and words for people, above all after a failure."""

        success: bool
        status_message: string
