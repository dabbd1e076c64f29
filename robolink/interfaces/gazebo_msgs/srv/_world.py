"""The world and its physics."""

from robolink.interfaces.gazebo_msgs.msg import ODEPhysics
from robolink.interfaces.geometry_msgs.msg import Vector3
from robolink.message import Message, Sequence, Service, float64, string


class GetWorldProperties(Service):
    """Return time and models of the world."""

    class Request(Message):
        """Nothing."""

    class Response(Message):
        """Simulated time in seconds, the models' names, and whether pictures are drawn."""

        sim_time: float64
        model_names: Sequence[string]
        rendering_enabled: bool
        success: bool
        status_message: string


class GetPhysicsProperties(Service):
    """Return the settings of the physics."""

    class Request(Message):
        """Nothing."""

    class Response(Message):
        """Step in seconds, steps in a second at most, gravity in m/s², and the engine's settings."""

        time_step: float64
        pause: bool
        max_update_rate: float64
        gravity: Vector3
        ode_config: ODEPhysics
        success: bool
        status_message: string


class SetPhysicsProperties(Service):
    """Set the settings of the physics."""

    class Request(Message):
        """Step in seconds, steps in a second at most, gravity in m/s², and the engine's settings."""

        time_step: float64
        max_update_rate: float64
        gravity: Vector3
        ode_config: ODEPhysics

    class Response(Message):
        """Success, and words for people, above all after a failure."""

        success: bool
        status_message: string
