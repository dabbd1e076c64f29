"""The messages of lifecycle_msgs: the states of a managed node, and the steps between them."""

from typing import ClassVar

from robolink.message import Message, string, uint8, uint64


class State(Message):
    """A state of a managed node: one of the codes below, and its name.

    In the PRIMARY states a node stays until it is told to go on: UNCONFIGURED when it is new, INACTIVE when it is set
    up but does nothing, ACTIVE when it works, FINALIZED when it can only be removed. In the TRANSITION states it is
    on its way, and its callback of that name runs.
    """

    PRIMARY_STATE_UNKNOWN: ClassVar[uint8] = 0
    PRIMARY_STATE_UNCONFIGURED: ClassVar[uint8] = 1
    PRIMARY_STATE_INACTIVE: ClassVar[uint8] = 2
    PRIMARY_STATE_ACTIVE: ClassVar[uint8] = 3
    PRIMARY_STATE_FINALIZED: ClassVar[uint8] = 4
    TRANSITION_STATE_CONFIGURING: ClassVar[uint8] = 10
    TRANSITION_STATE_CLEANINGUP: ClassVar[uint8] = 11
    TRANSITION_STATE_SHUTTINGDOWN: ClassVar[uint8] = 12
    TRANSITION_STATE_ACTIVATING: ClassVar[uint8] = 13
    TRANSITION_STATE_DEACTIVATING: ClassVar[uint8] = 14
    TRANSITION_STATE_ERRORPROCESSING: ClassVar[uint8] = 15

    id: uint8
    label: string


class Transition(Message):
    """A step from one state to another: one of the codes below, and its name.

    Only the codes from 1 to 8 can be asked for. Those from 10 to 62 say how a step ended, and those from 97 to 99 are
    what a callback gives back.
    """

    TRANSITION_CREATE: ClassVar[uint8] = 0
    TRANSITION_CONFIGURE: ClassVar[uint8] = 1
    TRANSITION_CLEANUP: ClassVar[uint8] = 2
    TRANSITION_ACTIVATE: ClassVar[uint8] = 3
    TRANSITION_DEACTIVATE: ClassVar[uint8] = 4
    TRANSITION_UNCONFIGURED_SHUTDOWN: ClassVar[uint8] = 5
    TRANSITION_INACTIVE_SHUTDOWN: ClassVar[uint8] = 6
    TRANSITION_ACTIVE_SHUTDOWN: ClassVar[uint8] = 7
    TRANSITION_DESTROY: ClassVar[uint8] = 8
    TRANSITION_ON_CONFIGURE_SUCCESS: ClassVar[uint8] = 10
    TRANSITION_ON_CONFIGURE_FAILURE: ClassVar[uint8] = 11
    TRANSITION_ON_CONFIGURE_ERROR: ClassVar[uint8] = 12
    TRANSITION_ON_CLEANUP_SUCCESS: ClassVar[uint8] = 20
    TRANSITION_ON_CLEANUP_FAILURE: ClassVar[uint8] = 21
    TRANSITION_ON_CLEANUP_ERROR: ClassVar[uint8] = 22
    TRANSITION_ON_ACTIVATE_SUCCESS: ClassVar[uint8] = 30
    TRANSITION_ON_ACTIVATE_FAILURE: ClassVar[uint8] = 31
    TRANSITION_ON_ACTIVATE_ERROR: ClassVar[uint8] = 32
    TRANSITION_ON_DEACTIVATE_SUCCESS: ClassVar[uint8] = 40
    TRANSITION_ON_DEACTIVATE_FAILURE: ClassVar[uint8] = 41
    TRANSITION_ON_DEACTIVATE_ERROR: ClassVar[uint8] = 42
    TRANSITION_ON_SHUTDOWN_SUCCESS: ClassVar[uint8] = 50
    TRANSITION_ON_SHUTDOWN_FAILURE: ClassVar[uint8] = 51
    TRANSITION_ON_SHUTDOWN_ERROR: ClassVar[uint8] = 52
    TRANSITION_ON_ERROR_SUCCESS: ClassVar[uint8] = 60
    TRANSITION_ON_ERROR_FAILURE: ClassVar[uint8] = 61
    TRANSITION_ON_ERROR_ERROR: ClassVar[uint8] = 62
    TRANSITION_CALLBACK_SUCCESS: ClassVar[uint8] = 97
    TRANSITION_CALLBACK_FAILURE: ClassVar[uint8] = 98
    TRANSITION_CALLBACK_ERROR: ClassVar[uint8] = 99

    id: uint8
    label: string


class TransitionDescription(Message):
    """A step, with the state that it starts from and the one that it leads to."""

    transition: Transition
    start_state: State
    goal_state: State


class TransitionEvent(Message):
    """A step that was made, as published on ``NODE/transition_event``; the timestamp is in nanoseconds."""

    timestamp: uint64
    transition: Transition
    start_state: State
    goal_state: State
