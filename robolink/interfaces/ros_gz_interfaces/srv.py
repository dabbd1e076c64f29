"""The services of ros_gz_interfaces: control the world, spawn, move and delete entities."""

from robolink.interfaces.geometry_msgs.msg import Pose
from robolink.interfaces.ros_gz_interfaces.msg import Entity, EntityFactory, WorldControl
from robolink.message import Message, Service


class ControlWorld(Service):
    """Pause, step, reset or run the simulation."""

    class Request(Message):
        """The order."""

        world_control: WorldControl

    class Response(Message):
        """Success."""

        success: bool


class SpawnEntity(Service):
    """Add an entity to the world."""

    class Request(Message):
        """The entity."""

        entity_factory: EntityFactory

    class Response(Message):
        """Success."""

        success: bool


class DeleteEntity(Service):
    """Remove an entity from the world."""

    class Request(Message):
        """The entity."""

        entity: Entity

    class Response(Message):
        """Success."""

        success: bool


class SetEntityPose(Service):
    """Move an entity."""

    class Request(Message):
        """The entity and its new pose."""

        entity: Entity
        pose: Pose

    class Response(Message):
        """Success."""

        success: bool
