# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message
import robolink.interfaces.controller_manager_msgs.msg
import robolink.interfaces.lifecycle_msgs.msg
import robolink.interfaces.std_msgs.msg

__all__ = ["ChainConnection", "ControllerManagerActivity", "ControllerState", "HardwareComponentState", "HardwareInterface", "NamedLifecycleState"]

class ChainConnection(robolink.message.Message):
    """A controller that is used by another, and the interfaces that it offers to that."""
    name: builtins.str
    reference_interfaces: collections.abc.MutableSequence[builtins.str]
    def __init__(self, *, name: builtins.str = ..., reference_interfaces: collections.abc.Iterable[builtins.str] = ...) -> None: ...
class ControllerManagerActivity(robolink.message.Message):
    """States of all controllers and all hardware, sent when one changes."""
    header: robolink.interfaces.std_msgs.msg.Header
    controllers: collections.abc.MutableSequence[robolink.interfaces.controller_manager_msgs.msg.NamedLifecycleState]
    hardware_components: collections.abc.MutableSequence[robolink.interfaces.controller_manager_msgs.msg.NamedLifecycleState]
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., controllers: collections.abc.Iterable[robolink.interfaces.controller_manager_msgs.msg.NamedLifecycleState] = ..., hardware_components: collections.abc.Iterable[robolink.interfaces.controller_manager_msgs.msg.NamedLifecycleState] = ...) -> None: ...
class ControllerState(robolink.message.Message):
    """A controller: its state and type, its rate in Hz, and the interfaces that it needs, has and offers."""
    name: builtins.str
    state: builtins.str
    type: builtins.str
    is_async: builtins.bool
    update_rate: builtins.int
    claimed_interfaces: collections.abc.MutableSequence[builtins.str]
    required_command_interfaces: collections.abc.MutableSequence[builtins.str]
    required_state_interfaces: collections.abc.MutableSequence[builtins.str]
    is_chainable: builtins.bool
    is_chained: builtins.bool
    exported_state_interfaces: collections.abc.MutableSequence[builtins.str]
    reference_interfaces: collections.abc.MutableSequence[builtins.str]
    chain_connections: collections.abc.MutableSequence[robolink.interfaces.controller_manager_msgs.msg.ChainConnection]
    def __init__(self, *, name: builtins.str = ..., state: builtins.str = ..., type: builtins.str = ..., is_async: builtins.bool = ..., update_rate: builtins.int = ..., claimed_interfaces: collections.abc.Iterable[builtins.str] = ..., required_command_interfaces: collections.abc.Iterable[builtins.str] = ..., required_state_interfaces: collections.abc.Iterable[builtins.str] = ..., is_chainable: builtins.bool = ..., is_chained: builtins.bool = ..., exported_state_interfaces: collections.abc.Iterable[builtins.str] = ..., reference_interfaces: collections.abc.Iterable[builtins.str] = ..., chain_connections: collections.abc.Iterable[robolink.interfaces.controller_manager_msgs.msg.ChainConnection] = ...) -> None: ...
class HardwareComponentState(robolink.message.Message):
    """A piece of hardware: its state, its plugin, its rate in Hz, and its interfaces."""
    name: builtins.str
    type: builtins.str
    is_async: builtins.bool
    rw_rate: builtins.int
    class_type: builtins.str
    plugin_name: builtins.str
    state: robolink.interfaces.lifecycle_msgs.msg.State
    command_interfaces: collections.abc.MutableSequence[robolink.interfaces.controller_manager_msgs.msg.HardwareInterface]
    state_interfaces: collections.abc.MutableSequence[robolink.interfaces.controller_manager_msgs.msg.HardwareInterface]
    def __init__(self, *, name: builtins.str = ..., type: builtins.str = ..., is_async: builtins.bool = ..., rw_rate: builtins.int = ..., class_type: builtins.str = ..., plugin_name: builtins.str = ..., state: robolink.interfaces.lifecycle_msgs.msg.State = ..., command_interfaces: collections.abc.Iterable[robolink.interfaces.controller_manager_msgs.msg.HardwareInterface] = ..., state_interfaces: collections.abc.Iterable[robolink.interfaces.controller_manager_msgs.msg.HardwareInterface] = ...) -> None: ...
class HardwareInterface(robolink.message.Message):
    """An interface of hardware, such as `joint1/position`: its type, and whether a controller has it."""
    name: builtins.str
    data_type: builtins.str
    is_available: builtins.bool
    is_claimed: builtins.bool
    def __init__(self, *, name: builtins.str = ..., data_type: builtins.str = ..., is_available: builtins.bool = ..., is_claimed: builtins.bool = ...) -> None: ...
class NamedLifecycleState(robolink.message.Message):
    """State of a controller or of hardware, by its name."""
    name: builtins.str
    state: robolink.interfaces.lifecycle_msgs.msg.State
    def __init__(self, *, name: builtins.str = ..., state: robolink.interfaces.lifecycle_msgs.msg.State = ...) -> None: ...
