# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message
import robolink.interfaces.type_description_interfaces.msg

__all__ = ["GetTypeDescription"]

class GetTypeDescription(robolink.message.Service):
    """Ask a node, at its service ``~/get_type_description``, for a type that it uses.

    Which type: its name (``geometry_msgs/msg/Twist``), and its RIHS hash where the version matters.

    `include_type_sources` asks for the text of the files as well.
    """
    class Request(robolink.message.Message):
        type_name: builtins.str
        type_hash: builtins.str
        include_type_sources: builtins.bool
        def __init__(self, *, type_name: builtins.str = ..., type_hash: builtins.str = ..., include_type_sources: builtins.bool = ...) -> None: ...
    class Response(robolink.message.Message):
        """The description; it only counts when `successful` is true, otherwise `failure_reason` says what is amiss.

        `type_sources` has the type's own file and those of all types that it is made of; `extra_information` is
        whatever else the node wants to tell.
        """
        successful: builtins.bool
        failure_reason: builtins.str
        type_description: robolink.interfaces.type_description_interfaces.msg.TypeDescription
        type_sources: collections.abc.MutableSequence[robolink.interfaces.type_description_interfaces.msg.TypeSource]
        extra_information: collections.abc.MutableSequence[robolink.interfaces.type_description_interfaces.msg.KeyValue]
        def __init__(self, *, successful: builtins.bool = ..., failure_reason: builtins.str = ..., type_description: robolink.interfaces.type_description_interfaces.msg.TypeDescription = ..., type_sources: collections.abc.Iterable[robolink.interfaces.type_description_interfaces.msg.TypeSource] = ..., extra_information: collections.abc.Iterable[robolink.interfaces.type_description_interfaces.msg.KeyValue] = ...) -> None: ...
