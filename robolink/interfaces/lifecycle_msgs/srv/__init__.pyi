# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message
import robolink.interfaces.lifecycle_msgs.msg

__all__ = ["ChangeState", "GetAvailableStates", "GetAvailableTransitions", "GetState"]

class ChangeState(robolink.message.Service):
    """Request a transition of a node; `ros2 lifecycle set` uses it.

    The step, by its id, or by its label where the id is 0.
    """
    class Request(robolink.message.Message):
        transition: robolink.interfaces.lifecycle_msgs.msg.Transition
        def __init__(self, *, transition: robolink.interfaces.lifecycle_msgs.msg.Transition = ...) -> None: ...
    class Response(robolink.message.Message):
        """True if the state has this transition, and it succeeded."""
        success: builtins.bool
        def __init__(self, *, success: builtins.bool = ...) -> None: ...
class GetAvailableStates(robolink.message.Service):
    """Ask a node for all states that it can be in.

    Nothing.
    """
    class Request(robolink.message.Message):
        def __init__(self) -> None: ...
    class Response(robolink.message.Message):
        """All states, the current one or not."""
        available_states: collections.abc.MutableSequence[robolink.interfaces.lifecycle_msgs.msg.State]
        def __init__(self, *, available_states: collections.abc.Iterable[robolink.interfaces.lifecycle_msgs.msg.State] = ...) -> None: ...
class GetAvailableTransitions(robolink.message.Service):
    """Ask a node for steps.

    At ``NODE/get_available_transitions`` it gives those that it can make now, at ``NODE/get_transition_graph`` all.

    Nothing.
    """
    class Request(robolink.message.Message):
        def __init__(self) -> None: ...
    class Response(robolink.message.Message):
        """The steps, each with its two states."""
        available_transitions: collections.abc.MutableSequence[robolink.interfaces.lifecycle_msgs.msg.TransitionDescription]
        def __init__(self, *, available_transitions: collections.abc.Iterable[robolink.interfaces.lifecycle_msgs.msg.TransitionDescription] = ...) -> None: ...
class GetState(robolink.message.Service):
    """Ask a node for its state.

    Nothing.
    """
    class Request(robolink.message.Message):
        def __init__(self) -> None: ...
    class Response(robolink.message.Message):
        """The state in which the node is now."""
        current_state: robolink.interfaces.lifecycle_msgs.msg.State
        def __init__(self, *, current_state: robolink.interfaces.lifecycle_msgs.msg.State = ...) -> None: ...
