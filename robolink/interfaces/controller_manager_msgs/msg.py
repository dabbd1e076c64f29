"""The messages of controller_manager_msgs: states of controllers and hardware."""

from robolink.interfaces.lifecycle_msgs.msg import State
from robolink.interfaces.std_msgs.msg import Header
from robolink.message import Message, Sequence, string, uint16


class ChainConnection(Message):
    """A controller that is used by another, and the interfaces that it offers to that."""

    name: string
    reference_interfaces: Sequence[string]


class ControllerState(Message):
    """A controller: its state and type, its rate in Hz, and the interfaces that it needs, has and offers."""

    name: string
    state: string
    type: string
    is_async: bool
    update_rate: uint16
    claimed_interfaces: Sequence[string]
    required_command_interfaces: Sequence[string]
    required_state_interfaces: Sequence[string]
    is_chainable: bool
    is_chained: bool
    exported_state_interfaces: Sequence[string]
    reference_interfaces: Sequence[string]
    chain_connections: Sequence[ChainConnection]


class NamedLifecycleState(Message):
    """State of a controller or of hardware, by its name."""

    name: string
    state: State


class ControllerManagerActivity(Message):
    """States of all controllers and all hardware, sent when one changes."""

    header: Header
    controllers: Sequence[NamedLifecycleState]
    hardware_components: Sequence[NamedLifecycleState]


class HardwareInterface(Message):
    """An interface of hardware, such as `joint1/position`: its type, and whether a controller has it."""

    name: string
    data_type: string
    is_available: bool
    is_claimed: bool


class HardwareComponentState(Message):
    """A piece of hardware: its state, its plugin, its rate in Hz, and its interfaces."""

    name: string
    type: string
    is_async: bool
    rw_rate: uint16
    class_type: string
    plugin_name: string
    state: State
    command_interfaces: Sequence[HardwareInterface]
    state_interfaces: Sequence[HardwareInterface]
