"""The services of composition_interfaces: nodes that are loaded into a running process and taken out of it."""

from robolink.interfaces.rcl_interfaces.msg import Parameter
from robolink.message import Message, Sequence, Service, string, uint8, uint64


class LoadNode(Service):
    """Load a node into a container."""

    class Request(Message):
        """Which node, by its package and the name under which that package offers it, and how to start it.

        An empty name or namespace is the node's own. `log_level` is a code of rcl_interfaces/msg/Log, 0 for the
        usual; `remap_rules` read ``old:=new``; `extra_arguments` are for the container itself.
        """

        package_name: string
        plugin_name: string
        node_name: string
        node_namespace: string
        log_level: uint8
        remap_rules: Sequence[string]
        parameters: Sequence[Parameter]
        extra_arguments: Sequence[Parameter]

    class Response(Message):
        """Success, or the reason of the failure.

        `full_node_name` and `unique_id` are the node's; the id is what UnloadNode takes.
        """

        success: bool
        error_message: string
        full_node_name: string
        unique_id: uint64


class UnloadNode(Service):
    """Take a node out of a container."""

    class Request(Message):
        """The node's id, from LoadNode or ListNodes."""

        unique_id: uint64

    class Response(Message):
        """Success, or the reason of the failure."""

        success: bool
        error_message: string


class ListNodes(Service):
    """Ask a container for its nodes."""

    class Request(Message):
        """Nothing."""

    class Response(Message):
        """The nodes' full names and, in the same order, their ids."""

        full_node_names: Sequence[string]
        unique_ids: Sequence[uint64]
