"""The services of controller_manager_msgs: list, load, switch and unload controllers."""

from typing import ClassVar

from robolink.interfaces.builtin_interfaces.msg import Duration
from robolink.interfaces.controller_manager_msgs.msg import ControllerState, HardwareComponentState, HardwareInterface
from robolink.interfaces.lifecycle_msgs.msg import State
from robolink.message import Message, Sequence, Service, int32, string


class ListControllers(Service):
    """List the controllers."""

    class Request(Message):
        """Nothing."""

    class Response(Message):
        """The controllers."""

        controller: Sequence[ControllerState]


class ListControllerTypes(Service):
    """List the types of controllers that can be loaded."""

    class Request(Message):
        """Nothing."""

    class Response(Message):
        """Names of the types and of their base classes, in the same order."""

        types: Sequence[string]
        base_classes: Sequence[string]


class ListHardwareComponents(Service):
    """List the hardware."""

    class Request(Message):
        """Nothing."""

    class Response(Message):
        """The hardware."""

        component: Sequence[HardwareComponentState]


class ListHardwareInterfaces(Service):
    """List the interfaces of the hardware."""

    class Request(Message):
        """Nothing."""

    class Response(Message):
        """Interfaces to write and interfaces to read."""

        command_interfaces: Sequence[HardwareInterface]
        state_interfaces: Sequence[HardwareInterface]


class LoadController(Service):
    """Load a controller."""

    class Request(Message):
        """The controller's name."""

        name: string

    class Response(Message):
        """True if that worked."""

        ok: bool


class ConfigureController(Service):
    """Configure a controller."""

    class Request(Message):
        """The controller's name."""

        name: string

    class Response(Message):
        """True if that worked."""

        ok: bool


class CleanupController(Service):
    """Bring a controller back to where it is not configured."""

    class Request(Message):
        """The controller's name."""

        name: string

    class Response(Message):
        """True if that worked."""

        ok: bool


class UnloadController(Service):
    """Unload a controller."""

    class Request(Message):
        """The controller's name."""

        name: string

    class Response(Message):
        """True if that worked."""

        ok: bool


class ReloadControllerLibraries(Service):
    """Load the libraries of controllers again."""

    class Request(Message):
        """True stops controllers that are running."""

        force_kill: bool

    class Response(Message):
        """True if that worked."""

        ok: bool


class SetHardwareComponentState(Service):
    """Bring a piece of hardware to a state."""

    class Request(Message):
        """Its name and the state."""

        name: string
        target_state: State

    class Response(Message):
        """Success, and the state that it has now."""

        ok: bool
        state: State


class SwitchController(Service):
    """Activate controllers and deactivate others, all at once."""

    class Request(Message):
        """The controllers, what to do if one cannot be switched, and how long to wait for it; 0 waits for ever."""

        BEST_EFFORT: ClassVar[int32] = 1
        STRICT: ClassVar[int32] = 2
        AUTO: ClassVar[int32] = 3
        FORCE_AUTO: ClassVar[int32] = 4

        activate_controllers: Sequence[string]
        deactivate_controllers: Sequence[string]
        strictness: int32
        activate_asap: bool
        timeout: Duration

    class Response(Message):
        """Success, and words for people."""

        ok: bool
        message: string
