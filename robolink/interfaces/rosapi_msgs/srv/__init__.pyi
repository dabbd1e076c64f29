# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message
import robolink.interfaces.builtin_interfaces.msg
import robolink.interfaces.rosapi_msgs.msg

__all__ = ["ActionType", "DeleteParam", "GetActionServers", "GetParam", "GetParamNames", "GetROSVersion", "GetTime", "HasParam", "Interfaces", "MessageDetails", "NodeDetails", "Nodes", "Publishers", "ServiceNode", "ServiceProviders", "ServiceRequestDetails", "ServiceResponseDetails", "ServiceType", "Services", "ServicesForType", "SetParam", "Subscribers", "TopicType", "Topics", "TopicsAndRawTypes", "TopicsForType"]

class ActionType(robolink.message.Service):
    """Return an action's type.

    The action's name.
    """
    class Request(robolink.message.Message):
        action: builtins.str
        def __init__(self, *, action: builtins.str = ...) -> None: ...
    class Response(robolink.message.Message):
        """The type, empty if there is no such action."""
        type: builtins.str
        def __init__(self, *, type: builtins.str = ...) -> None: ...
class DeleteParam(robolink.message.Service):
    """Remove a parameter.

    Name as NODE:PARAMETER.
    """
    class Request(robolink.message.Message):
        name: builtins.str
        def __init__(self, *, name: builtins.str = ...) -> None: ...
    class Response(robolink.message.Message):
        """Nothing."""
        def __init__(self) -> None: ...
class GetActionServers(robolink.message.Service):
    """List the actions that are served.

    Nothing.
    """
    class Request(robolink.message.Message):
        def __init__(self) -> None: ...
    class Response(robolink.message.Message):
        """Names of the actions."""
        action_servers: collections.abc.MutableSequence[builtins.str]
        def __init__(self, *, action_servers: collections.abc.Iterable[builtins.str] = ...) -> None: ...
class GetParam(robolink.message.Service):
    """Return a parameter's value.

    Name as NODE:PARAMETER, and the JSON text to return if it is not set.
    """
    class Request(robolink.message.Message):
        name: builtins.str
        default_value: builtins.str
        def __init__(self, *, name: builtins.str = ..., default_value: builtins.str = ...) -> None: ...
    class Response(robolink.message.Message):
        """The value as a JSON text."""
        value: builtins.str
        def __init__(self, *, value: builtins.str = ...) -> None: ...
class GetParamNames(robolink.message.Service):
    """List the parameters of all nodes.

    Nothing.
    """
    class Request(robolink.message.Message):
        def __init__(self) -> None: ...
    class Response(robolink.message.Message):
        """Names as NODE:PARAMETER."""
        names: collections.abc.MutableSequence[builtins.str]
        def __init__(self, *, names: collections.abc.Iterable[builtins.str] = ...) -> None: ...
class GetROSVersion(robolink.message.Service):
    """Return ROS's version.

    Nothing.
    """
    class Request(robolink.message.Message):
        def __init__(self) -> None: ...
    class Response(robolink.message.Message):
        """1 or 2, and the name of the distribution."""
        version: builtins.int
        distro: builtins.str
        def __init__(self, *, version: builtins.int = ..., distro: builtins.str = ...) -> None: ...
class GetTime(robolink.message.Service):
    """Return the present ROS time.

    Nothing.
    """
    class Request(robolink.message.Message):
        def __init__(self) -> None: ...
    class Response(robolink.message.Message):
        """The time."""
        time: robolink.interfaces.builtin_interfaces.msg.Time
        def __init__(self, *, time: robolink.interfaces.builtin_interfaces.msg.Time = ...) -> None: ...
class HasParam(robolink.message.Service):
    """Return whether there is a parameter.

    Name as NODE:PARAMETER.
    """
    class Request(robolink.message.Message):
        name: builtins.str
        def __init__(self, *, name: builtins.str = ...) -> None: ...
    class Response(robolink.message.Message):
        """True if there is one."""
        exists: builtins.bool
        def __init__(self, *, exists: builtins.bool = ...) -> None: ...
class Interfaces(robolink.message.Service):
    """List the types that are installed.

    Nothing.
    """
    class Request(robolink.message.Message):
        def __init__(self) -> None: ...
    class Response(robolink.message.Message):
        """Names of the types."""
        interfaces: collections.abc.MutableSequence[builtins.str]
        def __init__(self, *, interfaces: collections.abc.Iterable[builtins.str] = ...) -> None: ...
class MessageDetails(robolink.message.Service):
    """Return the definition of a message.

    The message type's name.
    """
    class Request(robolink.message.Message):
        type: builtins.str
        def __init__(self, *, type: builtins.str = ...) -> None: ...
    class Response(robolink.message.Message):
        """Definitions of the message and of all types in it."""
        typedefs: collections.abc.MutableSequence[robolink.interfaces.rosapi_msgs.msg.TypeDef]
        def __init__(self, *, typedefs: collections.abc.Iterable[robolink.interfaces.rosapi_msgs.msg.TypeDef] = ...) -> None: ...
class NodeDetails(robolink.message.Service):
    """Return what a node uses.

    The node's name.
    """
    class Request(robolink.message.Message):
        node: builtins.str
        def __init__(self, *, node: builtins.str = ...) -> None: ...
    class Response(robolink.message.Message):
        """Topics that it subscribes to, topics that it publishes, and its services."""
        subscribing: collections.abc.MutableSequence[builtins.str]
        publishing: collections.abc.MutableSequence[builtins.str]
        services: collections.abc.MutableSequence[builtins.str]
        def __init__(self, *, subscribing: collections.abc.Iterable[builtins.str] = ..., publishing: collections.abc.Iterable[builtins.str] = ..., services: collections.abc.Iterable[builtins.str] = ...) -> None: ...
class Nodes(robolink.message.Service):
    """List the nodes.

    Nothing.
    """
    class Request(robolink.message.Message):
        def __init__(self) -> None: ...
    class Response(robolink.message.Message):
        """Names of the nodes."""
        nodes: collections.abc.MutableSequence[builtins.str]
        def __init__(self, *, nodes: collections.abc.Iterable[builtins.str] = ...) -> None: ...
class Publishers(robolink.message.Service):
    """List the nodes that publish a topic.

    The topic's name.
    """
    class Request(robolink.message.Message):
        topic: builtins.str
        def __init__(self, *, topic: builtins.str = ...) -> None: ...
    class Response(robolink.message.Message):
        """Names of the nodes."""
        publishers: collections.abc.MutableSequence[builtins.str]
        def __init__(self, *, publishers: collections.abc.Iterable[builtins.str] = ...) -> None: ...
class ServiceNode(robolink.message.Service):
    """Return the node that has a service.

    The service's name.
    """
    class Request(robolink.message.Message):
        service: builtins.str
        def __init__(self, *, service: builtins.str = ...) -> None: ...
    class Response(robolink.message.Message):
        """The node's name."""
        node: builtins.str
        def __init__(self, *, node: builtins.str = ...) -> None: ...
class ServiceProviders(robolink.message.Service):
    """List the nodes that have a service.

    The service's name.
    """
    class Request(robolink.message.Message):
        service: builtins.str
        def __init__(self, *, service: builtins.str = ...) -> None: ...
    class Response(robolink.message.Message):
        """Names of the nodes."""
        providers: collections.abc.MutableSequence[builtins.str]
        def __init__(self, *, providers: collections.abc.Iterable[builtins.str] = ...) -> None: ...
class ServiceRequestDetails(robolink.message.Service):
    """Return the definition of a service's request.

    The service type's name.
    """
    class Request(robolink.message.Message):
        type: builtins.str
        def __init__(self, *, type: builtins.str = ...) -> None: ...
    class Response(robolink.message.Message):
        """Definitions of the request and of all types in it."""
        typedefs: collections.abc.MutableSequence[robolink.interfaces.rosapi_msgs.msg.TypeDef]
        def __init__(self, *, typedefs: collections.abc.Iterable[robolink.interfaces.rosapi_msgs.msg.TypeDef] = ...) -> None: ...
class ServiceResponseDetails(robolink.message.Service):
    """Return the definition of a service's response.

    The service type's name.
    """
    class Request(robolink.message.Message):
        type: builtins.str
        def __init__(self, *, type: builtins.str = ...) -> None: ...
    class Response(robolink.message.Message):
        """Definitions of the response and of all types in it."""
        typedefs: collections.abc.MutableSequence[robolink.interfaces.rosapi_msgs.msg.TypeDef]
        def __init__(self, *, typedefs: collections.abc.Iterable[robolink.interfaces.rosapi_msgs.msg.TypeDef] = ...) -> None: ...
class ServiceType(robolink.message.Service):
    """Return a service's type.

    The service's name.
    """
    class Request(robolink.message.Message):
        service: builtins.str
        def __init__(self, *, service: builtins.str = ...) -> None: ...
    class Response(robolink.message.Message):
        """The type, empty if there is no such service."""
        type: builtins.str
        def __init__(self, *, type: builtins.str = ...) -> None: ...
class Services(robolink.message.Service):
    """List the services.

    Nothing.
    """
    class Request(robolink.message.Message):
        def __init__(self) -> None: ...
    class Response(robolink.message.Message):
        """Names of the services."""
        services: collections.abc.MutableSequence[builtins.str]
        def __init__(self, *, services: collections.abc.Iterable[builtins.str] = ...) -> None: ...
class ServicesForType(robolink.message.Service):
    """List the services of a type.

    The type's name.
    """
    class Request(robolink.message.Message):
        type: builtins.str
        def __init__(self, *, type: builtins.str = ...) -> None: ...
    class Response(robolink.message.Message):
        """Names of the services."""
        services: collections.abc.MutableSequence[builtins.str]
        def __init__(self, *, services: collections.abc.Iterable[builtins.str] = ...) -> None: ...
class SetParam(robolink.message.Service):
    """Set a parameter.

    Name as NODE:PARAMETER, and the value as a JSON text.
    """
    class Request(robolink.message.Message):
        name: builtins.str
        value: builtins.str
        def __init__(self, *, name: builtins.str = ..., value: builtins.str = ...) -> None: ...
    class Response(robolink.message.Message):
        """Nothing."""
        def __init__(self) -> None: ...
class Subscribers(robolink.message.Service):
    """List the nodes that subscribe to a topic.

    The topic's name.
    """
    class Request(robolink.message.Message):
        topic: builtins.str
        def __init__(self, *, topic: builtins.str = ...) -> None: ...
    class Response(robolink.message.Message):
        """Names of the nodes."""
        subscribers: collections.abc.MutableSequence[builtins.str]
        def __init__(self, *, subscribers: collections.abc.Iterable[builtins.str] = ...) -> None: ...
class TopicType(robolink.message.Service):
    """Return a topic's type.

    The topic's name.
    """
    class Request(robolink.message.Message):
        topic: builtins.str
        def __init__(self, *, topic: builtins.str = ...) -> None: ...
    class Response(robolink.message.Message):
        """The type, empty if there is no such topic."""
        type: builtins.str
        def __init__(self, *, type: builtins.str = ...) -> None: ...
class Topics(robolink.message.Service):
    """List the topics.

    Nothing.
    """
    class Request(robolink.message.Message):
        def __init__(self) -> None: ...
    class Response(robolink.message.Message):
        """Names of the topics and, in the same order, of their types."""
        topics: collections.abc.MutableSequence[builtins.str]
        types: collections.abc.MutableSequence[builtins.str]
        def __init__(self, *, topics: collections.abc.Iterable[builtins.str] = ..., types: collections.abc.Iterable[builtins.str] = ...) -> None: ...
class TopicsAndRawTypes(robolink.message.Service):
    """List the topics with their types' definitions.

    Nothing.
    """
    class Request(robolink.message.Message):
        def __init__(self) -> None: ...
    class Response(robolink.message.Message):
        """Topics, their types, and the texts of the definitions, in the same order."""
        topics: collections.abc.MutableSequence[builtins.str]
        types: collections.abc.MutableSequence[builtins.str]
        typedefs_full_text: collections.abc.MutableSequence[builtins.str]
        def __init__(self, *, topics: collections.abc.Iterable[builtins.str] = ..., types: collections.abc.Iterable[builtins.str] = ..., typedefs_full_text: collections.abc.Iterable[builtins.str] = ...) -> None: ...
class TopicsForType(robolink.message.Service):
    """List the topics of a type.

    The type's name.
    """
    class Request(robolink.message.Message):
        type: builtins.str
        def __init__(self, *, type: builtins.str = ...) -> None: ...
    class Response(robolink.message.Message):
        """Names of the topics."""
        topics: collections.abc.MutableSequence[builtins.str]
        def __init__(self, *, topics: collections.abc.Iterable[builtins.str] = ...) -> None: ...
