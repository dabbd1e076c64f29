# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message
import robolink.interfaces.geometry_msgs.msg
import robolink.interfaces.ros_gz_interfaces.msg

__all__ = ["ControlWorld", "DeleteEntity", "SetEntityPose", "SpawnEntity"]

class ControlWorld(robolink.message.Service):
    """Pause, step, reset or run the simulation.

    The order.
    """
    class Request(robolink.message.Message):
        world_control: robolink.interfaces.ros_gz_interfaces.msg.WorldControl
        def __init__(self, *, world_control: robolink.interfaces.ros_gz_interfaces.msg.WorldControl = ...) -> None: ...
    class Response(robolink.message.Message):
        """Success."""
        success: builtins.bool
        def __init__(self, *, success: builtins.bool = ...) -> None: ...
class DeleteEntity(robolink.message.Service):
    """Remove an entity from the world.

    The entity.
    """
    class Request(robolink.message.Message):
        entity: robolink.interfaces.ros_gz_interfaces.msg.Entity
        def __init__(self, *, entity: robolink.interfaces.ros_gz_interfaces.msg.Entity = ...) -> None: ...
    class Response(robolink.message.Message):
        """Success."""
        success: builtins.bool
        def __init__(self, *, success: builtins.bool = ...) -> None: ...
class SetEntityPose(robolink.message.Service):
    """Move an entity.

    The entity and its new pose.
    """
    class Request(robolink.message.Message):
        entity: robolink.interfaces.ros_gz_interfaces.msg.Entity
        pose: robolink.interfaces.geometry_msgs.msg.Pose
        def __init__(self, *, entity: robolink.interfaces.ros_gz_interfaces.msg.Entity = ..., pose: robolink.interfaces.geometry_msgs.msg.Pose = ...) -> None: ...
    class Response(robolink.message.Message):
        """Success."""
        success: builtins.bool
        def __init__(self, *, success: builtins.bool = ...) -> None: ...
class SpawnEntity(robolink.message.Service):
    """Add an entity to the world.

    The entity.
    """
    class Request(robolink.message.Message):
        entity_factory: robolink.interfaces.ros_gz_interfaces.msg.EntityFactory
        def __init__(self, *, entity_factory: robolink.interfaces.ros_gz_interfaces.msg.EntityFactory = ...) -> None: ...
    class Response(robolink.message.Message):
        """Success."""
        success: builtins.bool
        def __init__(self, *, success: builtins.bool = ...) -> None: ...
