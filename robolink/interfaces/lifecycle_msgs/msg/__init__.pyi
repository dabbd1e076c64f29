# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message
import robolink.interfaces.lifecycle_msgs.msg

__all__ = ["State", "Transition", "TransitionDescription", "TransitionEvent"]

class State(robolink.message.Message):
    """A state of a managed node: one of the codes below, and its name.

    In the PRIMARY states a node stays until it is told to go on: UNCONFIGURED when it is new, INACTIVE when it is set
    up but does nothing, ACTIVE when it works, FINALIZED when it can only be removed. In the TRANSITION states it is
    on its way, and its callback of that name runs.
    """
    PRIMARY_STATE_UNKNOWN: typing.ClassVar[builtins.int]
    PRIMARY_STATE_UNCONFIGURED: typing.ClassVar[builtins.int]
    PRIMARY_STATE_INACTIVE: typing.ClassVar[builtins.int]
    PRIMARY_STATE_ACTIVE: typing.ClassVar[builtins.int]
    PRIMARY_STATE_FINALIZED: typing.ClassVar[builtins.int]
    TRANSITION_STATE_CONFIGURING: typing.ClassVar[builtins.int]
    TRANSITION_STATE_CLEANINGUP: typing.ClassVar[builtins.int]
    TRANSITION_STATE_SHUTTINGDOWN: typing.ClassVar[builtins.int]
    TRANSITION_STATE_ACTIVATING: typing.ClassVar[builtins.int]
    TRANSITION_STATE_DEACTIVATING: typing.ClassVar[builtins.int]
    TRANSITION_STATE_ERRORPROCESSING: typing.ClassVar[builtins.int]
    id: builtins.int
    label: builtins.str
    def __init__(self, *, id: builtins.int = ..., label: builtins.str = ...) -> None: ...
class Transition(robolink.message.Message):
    """A step from one state to another: one of the codes below, and its name.

    Only the codes from 1 to 8 can be asked for. Those from 10 to 62 say how a step ended, and those from 97 to 99 are
    what a callback gives back.
    """
    TRANSITION_CREATE: typing.ClassVar[builtins.int]
    TRANSITION_CONFIGURE: typing.ClassVar[builtins.int]
    TRANSITION_CLEANUP: typing.ClassVar[builtins.int]
    TRANSITION_ACTIVATE: typing.ClassVar[builtins.int]
    TRANSITION_DEACTIVATE: typing.ClassVar[builtins.int]
    TRANSITION_UNCONFIGURED_SHUTDOWN: typing.ClassVar[builtins.int]
    TRANSITION_INACTIVE_SHUTDOWN: typing.ClassVar[builtins.int]
    TRANSITION_ACTIVE_SHUTDOWN: typing.ClassVar[builtins.int]
    TRANSITION_DESTROY: typing.ClassVar[builtins.int]
    TRANSITION_ON_CONFIGURE_SUCCESS: typing.ClassVar[builtins.int]
    TRANSITION_ON_CONFIGURE_FAILURE: typing.ClassVar[builtins.int]
    TRANSITION_ON_CONFIGURE_ERROR: typing.ClassVar[builtins.int]
    TRANSITION_ON_CLEANUP_SUCCESS: typing.ClassVar[builtins.int]
    TRANSITION_ON_CLEANUP_FAILURE: typing.ClassVar[builtins.int]
    TRANSITION_ON_CLEANUP_ERROR: typing.ClassVar[builtins.int]
    TRANSITION_ON_ACTIVATE_SUCCESS: typing.ClassVar[builtins.int]
    TRANSITION_ON_ACTIVATE_FAILURE: typing.ClassVar[builtins.int]
    TRANSITION_ON_ACTIVATE_ERROR: typing.ClassVar[builtins.int]
    TRANSITION_ON_DEACTIVATE_SUCCESS: typing.ClassVar[builtins.int]
    TRANSITION_ON_DEACTIVATE_FAILURE: typing.ClassVar[builtins.int]
    TRANSITION_ON_DEACTIVATE_ERROR: typing.ClassVar[builtins.int]
    TRANSITION_ON_SHUTDOWN_SUCCESS: typing.ClassVar[builtins.int]
    TRANSITION_ON_SHUTDOWN_FAILURE: typing.ClassVar[builtins.int]
    TRANSITION_ON_SHUTDOWN_ERROR: typing.ClassVar[builtins.int]
    TRANSITION_ON_ERROR_SUCCESS: typing.ClassVar[builtins.int]
    TRANSITION_ON_ERROR_FAILURE: typing.ClassVar[builtins.int]
    TRANSITION_ON_ERROR_ERROR: typing.ClassVar[builtins.int]
    TRANSITION_CALLBACK_SUCCESS: typing.ClassVar[builtins.int]
    TRANSITION_CALLBACK_FAILURE: typing.ClassVar[builtins.int]
    TRANSITION_CALLBACK_ERROR: typing.ClassVar[builtins.int]
    id: builtins.int
    label: builtins.str
    def __init__(self, *, id: builtins.int = ..., label: builtins.str = ...) -> None: ...
class TransitionDescription(robolink.message.Message):
    """A step, with the state that it starts from and the one that it leads to."""
    transition: robolink.interfaces.lifecycle_msgs.msg.Transition
    start_state: robolink.interfaces.lifecycle_msgs.msg.State
    goal_state: robolink.interfaces.lifecycle_msgs.msg.State
    def __init__(self, *, transition: robolink.interfaces.lifecycle_msgs.msg.Transition = ..., start_state: robolink.interfaces.lifecycle_msgs.msg.State = ..., goal_state: robolink.interfaces.lifecycle_msgs.msg.State = ...) -> None: ...
class TransitionEvent(robolink.message.Message):
    """A step that was made, as published on ``NODE/transition_event``; the timestamp is in nanoseconds."""
    timestamp: builtins.int
    transition: robolink.interfaces.lifecycle_msgs.msg.Transition
    start_state: robolink.interfaces.lifecycle_msgs.msg.State
    goal_state: robolink.interfaces.lifecycle_msgs.msg.State
    def __init__(self, *, timestamp: builtins.int = ..., transition: robolink.interfaces.lifecycle_msgs.msg.Transition = ..., start_state: robolink.interfaces.lifecycle_msgs.msg.State = ..., goal_state: robolink.interfaces.lifecycle_msgs.msg.State = ...) -> None: ...
