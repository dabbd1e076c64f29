"""Links, joints and lights: their properties, and forces on them."""

from typing import ClassVar

from robolink.interfaces.builtin_interfaces.msg import Duration, Time
from robolink.interfaces.gazebo_msgs.msg import LinkState, ODEJointProperties
from robolink.interfaces.geometry_msgs.msg import Point, Pose, Wrench
from robolink.interfaces.std_msgs.msg import ColorRGBA
from robolink.message import Message, Sequence, Service, float64, string, uint8


class ApplyBodyWrench(Service):
    """Push a body."""

    class Request(Message):
        """The body, a point at which to push, the force (N) and torque (Nm), and from when and for how long.

        The point is in the reference frame. A negative duration is without end, a start of 0 is at once.
        """

        body_name: string
        reference_frame: string
        reference_point: Point
        wrench: Wrench
        start_time: Time
        duration: Duration

    class Response(Message):
        """Success, and words for people, above all after a failure."""

        success: bool
        status_message: string


class ApplyLinkWrench(Service):
    """Push a link."""

    class Request(Message):
        """The link, a point at which to push, the force (N) and torque (Nm), and from when and for how long.

        The point is in the reference frame. A negative duration is without end, a start of 0 is at once.
        """

        link_name: string
        reference_frame: string
        reference_point: Point
        wrench: Wrench
        start_time: Time
        duration: Duration

    class Response(Message):
        """Success, and words for people, above all after a failure."""

        success: bool
        status_message: string


class ApplyJointEffort(Service):
    """Push a joint."""

    class Request(Message):
        """The joint, the force (N) or torque (Nm), and from when and for how long.

        A negative duration is without end, a start of 0 is at once.
        """

        joint_name: string
        effort: float64
        start_time: Time
        duration: Duration

    class Response(Message):
        """Success, and words for people, above all after a failure."""

        success: bool
        status_message: string


class BodyRequest(Service):
    """End the pushing of a body."""

    class Request(Message):
        """The body, named MODEL::LINK."""

        body_name: string

    class Response(Message):
        """Nothing."""


class LinkRequest(Service):
    """End the pushing of a link."""

    class Request(Message):
        """The link, named MODEL::LINK."""

        link_name: string

    class Response(Message):
        """Nothing."""


class JointRequest(Service):
    """End the pushing of a joint."""

    class Request(Message):
        """The joint's name."""

        joint_name: string

    class Response(Message):
        """Nothing."""


class GetLinkState(Service):
    """Return pose and velocity of a link."""

    class Request(Message):
        """The link, and the one in whose frame to express them."""

        link_name: string
        reference_frame: string

    class Response(Message):
        """The state, or no success and why."""

        link_state: LinkState
        success: bool
        status_message: string


class SetLinkState(Service):
    """Move a link."""

    class Request(Message):
        """The new state."""

        link_state: LinkState

    class Response(Message):
        """Success, and words for people, above all after a failure."""

        success: bool
        status_message: string


class GetLinkProperties(Service):
    """Return mass and inertia of a link."""

    class Request(Message):
        """The link's name."""

        link_name: string

    class Response(Message):
        """Centre of mass, mass in kg and moments of inertia in kg m²; `gravity_mode` True lets gravity pull."""

        com: Pose
        gravity_mode: bool
        mass: float64
        ixx: float64
        ixy: float64
        ixz: float64
        iyy: float64
        iyz: float64
        izz: float64
        success: bool
        status_message: string


class SetLinkProperties(Service):
    """Set mass and inertia of a link."""

    class Request(Message):
        """Centre of mass, mass in kg and moments of inertia in kg m²; `gravity_mode` True lets gravity pull."""

        link_name: string
        com: Pose
        gravity_mode: bool
        mass: float64
        ixx: float64
        ixy: float64
        ixz: float64
        iyy: float64
        iyz: float64
        izz: float64

    class Response(Message):
        """Success, and words for people, above all after a failure."""

        success: bool
        status_message: string


class GetJointProperties(Service):
    """Return kind, position and velocity of a joint."""

    class Request(Message):
        """The joint's name."""

        joint_name: string

    class Response(Message):
        """Kind of the joint, and for each axis damping, position (rad or m) and velocity."""

        REVOLUTE: ClassVar[uint8] = 0
        CONTINUOUS: ClassVar[uint8] = 1
        PRISMATIC: ClassVar[uint8] = 2
        FIXED: ClassVar[uint8] = 3
        BALL: ClassVar[uint8] = 4
        UNIVERSAL: ClassVar[uint8] = 5

        type: uint8
        damping: Sequence[float64]
        position: Sequence[float64]
        rate: Sequence[float64]
        success: bool
        status_message: string


class SetJointProperties(Service):
    """Set how the physics engine treats a joint."""

    class Request(Message):
        """The joint and its settings."""

        joint_name: string
        ode_joint_config: ODEJointProperties

    class Response(Message):
        """Success, and words for people, above all after a failure."""

        success: bool
        status_message: string


class GetLightProperties(Service):
    """Return a light's colour and range."""

    class Request(Message):
        """The light's name."""

        light_name: string

    class Response(Message):
        """Colour, and the three terms by which the light fades with distance."""

        diffuse: ColorRGBA
        attenuation_constant: float64
        attenuation_linear: float64
        attenuation_quadratic: float64
        success: bool
        status_message: string


class SetLightProperties(Service):
    """Set a light's colour and range."""

    class Request(Message):
        """Colour, and the three terms by which the light fades with distance."""

        light_name: string
        diffuse: ColorRGBA
        attenuation_constant: float64
        attenuation_linear: float64
        attenuation_quadratic: float64

    class Response(Message):
        """Success, and words for people, above all after a failure."""

        success: bool
        status_message: string


class DeleteLight(Service):
    """Remove a light from the world."""

    class Request(Message):
        """The light's name."""

        light_name: string

    class Response(Message):
        """Success, and words for people, above all after a failure."""

        success: bool
        status_message: string
