"""The services of lifecycle_msgs: asking a managed node for its state, and telling it to change it."""

from robolink.interfaces.lifecycle_msgs.msg import State, Transition, TransitionDescription
from robolink.message import Message, Sequence, Service


class ChangeState(Service):
    """Request a transition of a node; `ros2 lifecycle set` uses it."""

    class Request(Message):
        """The step, by its id, or by its label where the id is 0."""

        transition: Transition

    class Response(Message):
        """True if the state has this transition, and it succeeded."""

        success: bool


class GetState(Service):
    """Ask a node for its state."""

    class Request(Message):
        """Nothing."""

    class Response(Message):
        """The state in which the node is now."""

        current_state: State


class GetAvailableStates(Service):
    """Ask a node for all states that it can be in."""

    class Request(Message):
        """Nothing."""

    class Response(Message):
        """All states, the current one or not."""

        available_states: Sequence[State]


class GetAvailableTransitions(Service):
    """Ask a node for steps.

    At ``NODE/get_available_transitions`` it gives those that it can make now, at ``NODE/get_transition_graph`` all.
    """

    class Request(Message):
        """Nothing."""

    class Response(Message):
        """The steps, each with its two states."""

        available_transitions: Sequence[TransitionDescription]
