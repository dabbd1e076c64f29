# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message
import robolink.interfaces.builtin_interfaces.msg
import robolink.interfaces.controller_manager_msgs.msg
import robolink.interfaces.lifecycle_msgs.msg

__all__ = ["CleanupController", "ConfigureController", "ListControllerTypes", "ListControllers", "ListHardwareComponents", "ListHardwareInterfaces", "LoadController", "ReloadControllerLibraries", "SetHardwareComponentState", "SwitchController", "UnloadController"]

class CleanupController(robolink.message.Service):
    """Bring a controller back to where it is not configured.

    The controller's name.
    """
    class Request(robolink.message.Message):
        name: builtins.str
        def __init__(self, *, name: builtins.str = ...) -> None: ...
    class Response(robolink.message.Message):
        """True if that worked."""
        ok: builtins.bool
        def __init__(self, *, ok: builtins.bool = ...) -> None: ...
class ConfigureController(robolink.message.Service):
    """Configure a controller.

    The controller's name.
    """
    class Request(robolink.message.Message):
        name: builtins.str
        def __init__(self, *, name: builtins.str = ...) -> None: ...
    class Response(robolink.message.Message):
        """True if that worked."""
        ok: builtins.bool
        def __init__(self, *, ok: builtins.bool = ...) -> None: ...
class ListControllerTypes(robolink.message.Service):
    """List the types of controllers that can be loaded.

    Nothing.
    """
    class Request(robolink.message.Message):
        def __init__(self) -> None: ...
    class Response(robolink.message.Message):
        """Names of the types and of their base classes, in the same order."""
        types: collections.abc.MutableSequence[builtins.str]
        base_classes: collections.abc.MutableSequence[builtins.str]
        def __init__(self, *, types: collections.abc.Iterable[builtins.str] = ..., base_classes: collections.abc.Iterable[builtins.str] = ...) -> None: ...
class ListControllers(robolink.message.Service):
    """List the controllers.

    Nothing.
    """
    class Request(robolink.message.Message):
        def __init__(self) -> None: ...
    class Response(robolink.message.Message):
        """The controllers."""
        controller: collections.abc.MutableSequence[robolink.interfaces.controller_manager_msgs.msg.ControllerState]
        def __init__(self, *, controller: collections.abc.Iterable[robolink.interfaces.controller_manager_msgs.msg.ControllerState] = ...) -> None: ...
class ListHardwareComponents(robolink.message.Service):
    """List the hardware.

    Nothing.
    """
    class Request(robolink.message.Message):
        def __init__(self) -> None: ...
    class Response(robolink.message.Message):
        """The hardware."""
        component: collections.abc.MutableSequence[robolink.interfaces.controller_manager_msgs.msg.HardwareComponentState]
        def __init__(self, *, component: collections.abc.Iterable[robolink.interfaces.controller_manager_msgs.msg.HardwareComponentState] = ...) -> None: ...
class ListHardwareInterfaces(robolink.message.Service):
    """List the interfaces of the hardware.

    Nothing.
    """
    class Request(robolink.message.Message):
        def __init__(self) -> None: ...
    class Response(robolink.message.Message):
        """Interfaces to write and interfaces to read."""
        command_interfaces: collections.abc.MutableSequence[robolink.interfaces.controller_manager_msgs.msg.HardwareInterface]
        state_interfaces: collections.abc.MutableSequence[robolink.interfaces.controller_manager_msgs.msg.HardwareInterface]
        def __init__(self, *, command_interfaces: collections.abc.Iterable[robolink.interfaces.controller_manager_msgs.msg.HardwareInterface] = ..., state_interfaces: collections.abc.Iterable[robolink.interfaces.controller_manager_msgs.msg.HardwareInterface] = ...) -> None: ...
class LoadController(robolink.message.Service):
    """Load a controller.

    The controller's name.
    """
    class Request(robolink.message.Message):
        name: builtins.str
        def __init__(self, *, name: builtins.str = ...) -> None: ...
    class Response(robolink.message.Message):
        """True if that worked."""
        ok: builtins.bool
        def __init__(self, *, ok: builtins.bool = ...) -> None: ...
class ReloadControllerLibraries(robolink.message.Service):
    """Load the libraries of controllers again.

    True stops controllers that are running.
    """
    class Request(robolink.message.Message):
        force_kill: builtins.bool
        def __init__(self, *, force_kill: builtins.bool = ...) -> None: ...
    class Response(robolink.message.Message):
        """True if that worked."""
        ok: builtins.bool
        def __init__(self, *, ok: builtins.bool = ...) -> None: ...
class SetHardwareComponentState(robolink.message.Service):
    """Bring a piece of hardware to a state.

    Its name and the state.
    """
    class Request(robolink.message.Message):
        name: builtins.str
        target_state: robolink.interfaces.lifecycle_msgs.msg.State
        def __init__(self, *, name: builtins.str = ..., target_state: robolink.interfaces.lifecycle_msgs.msg.State = ...) -> None: ...
    class Response(robolink.message.Message):
        """Success, and the state that it has now."""
        ok: builtins.bool
        state: robolink.interfaces.lifecycle_msgs.msg.State
        def __init__(self, *, ok: builtins.bool = ..., state: robolink.interfaces.lifecycle_msgs.msg.State = ...) -> None: ...
class SwitchController(robolink.message.Service):
    """Activate controllers and deactivate others, all at once.

    The controllers, what to do if one cannot be switched, and how long to wait for it; 0 waits for ever.
    """
    class Request(robolink.message.Message):
        BEST_EFFORT: typing.ClassVar[builtins.int]
        STRICT: typing.ClassVar[builtins.int]
        AUTO: typing.ClassVar[builtins.int]
        FORCE_AUTO: typing.ClassVar[builtins.int]
        activate_controllers: collections.abc.MutableSequence[builtins.str]
        deactivate_controllers: collections.abc.MutableSequence[builtins.str]
        strictness: builtins.int
        activate_asap: builtins.bool
        timeout: robolink.interfaces.builtin_interfaces.msg.Duration
        def __init__(self, *, activate_controllers: collections.abc.Iterable[builtins.str] = ..., deactivate_controllers: collections.abc.Iterable[builtins.str] = ..., strictness: builtins.int = ..., activate_asap: builtins.bool = ..., timeout: robolink.interfaces.builtin_interfaces.msg.Duration = ...) -> None: ...
    class Response(robolink.message.Message):
        """Success, and words for people."""
        ok: builtins.bool
        message: builtins.str
        def __init__(self, *, ok: builtins.bool = ..., message: builtins.str = ...) -> None: ...
class UnloadController(robolink.message.Service):
    """Unload a controller.

    The controller's name.
    """
    class Request(robolink.message.Message):
        name: builtins.str
        def __init__(self, *, name: builtins.str = ...) -> None: ...
    class Response(robolink.message.Message):
        """True if that worked."""
        ok: builtins.bool
        def __init__(self, *, ok: builtins.bool = ...) -> None: ...
