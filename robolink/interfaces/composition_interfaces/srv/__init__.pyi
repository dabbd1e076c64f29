# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message
import robolink.interfaces.rcl_interfaces.msg

__all__ = ["ListNodes", "LoadNode", "UnloadNode"]

class ListNodes(robolink.message.Service):
    """Ask a container for its nodes.

    Nothing.
    """
    class Request(robolink.message.Message):
        def __init__(self) -> None: ...
    class Response(robolink.message.Message):
        """The nodes' full names and, in the same order, their ids."""
        full_node_names: collections.abc.MutableSequence[builtins.str]
        unique_ids: collections.abc.MutableSequence[builtins.int]
        def __init__(self, *, full_node_names: collections.abc.Iterable[builtins.str] = ..., unique_ids: collections.abc.Iterable[builtins.int] = ...) -> None: ...
class LoadNode(robolink.message.Service):
    """Load a node into a container.

    Which node, by its package and the name under which that package offers it, and how to start it.

    An empty name or namespace is the node's own. `log_level` is a code of rcl_interfaces/msg/Log, 0 for the
    usual; `remap_rules` read ``old:=new``; `extra_arguments` are for the container itself.
    """
    class Request(robolink.message.Message):
        package_name: builtins.str
        plugin_name: builtins.str
        node_name: builtins.str
        node_namespace: builtins.str
        log_level: builtins.int
        remap_rules: collections.abc.MutableSequence[builtins.str]
        parameters: collections.abc.MutableSequence[robolink.interfaces.rcl_interfaces.msg.Parameter]
        extra_arguments: collections.abc.MutableSequence[robolink.interfaces.rcl_interfaces.msg.Parameter]
        def __init__(self, *, package_name: builtins.str = ..., plugin_name: builtins.str = ..., node_name: builtins.str = ..., node_namespace: builtins.str = ..., log_level: builtins.int = ..., remap_rules: collections.abc.Iterable[builtins.str] = ..., parameters: collections.abc.Iterable[robolink.interfaces.rcl_interfaces.msg.Parameter] = ..., extra_arguments: collections.abc.Iterable[robolink.interfaces.rcl_interfaces.msg.Parameter] = ...) -> None: ...
    class Response(robolink.message.Message):
        """Success, or the reason of the failure.

        `full_node_name` and `unique_id` are the node's; the id is what UnloadNode takes.
        """
        success: builtins.bool
        error_message: builtins.str
        full_node_name: builtins.str
        unique_id: builtins.int
        def __init__(self, *, success: builtins.bool = ..., error_message: builtins.str = ..., full_node_name: builtins.str = ..., unique_id: builtins.int = ...) -> None: ...
class UnloadNode(robolink.message.Service):
    """Take a node out of a container.

    The node's id, from LoadNode or ListNodes.
    """
    class Request(robolink.message.Message):
        unique_id: builtins.int
        def __init__(self, *, unique_id: builtins.int = ...) -> None: ...
    class Response(robolink.message.Message):
        """Success, or the reason of the failure."""
        success: builtins.bool
        error_message: builtins.str
        def __init__(self, *, success: builtins.bool = ..., error_message: builtins.str = ...) -> None: ...
