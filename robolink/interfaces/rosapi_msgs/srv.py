"""The services of rosapi_msgs: the graph, types and parameters."""

from robolink.interfaces.builtin_interfaces.msg import Time
from robolink.interfaces.rosapi_msgs.msg import TypeDef
from robolink.message import Message, Sequence, Service, string, uint8


class Topics(Service):
    """List the topics."""

    class Request(Message):
        """Nothing."""

    class Response(Message):
        """Names of the topics and, in the same order, of their types."""

        topics: Sequence[string]
        types: Sequence[string]


class TopicsAndRawTypes(Service):
    """List the topics with their types' definitions."""

    class Request(Message):
        """Nothing."""

    class Response(Message):
        """Topics, their types, and the texts of the definitions, in the same order."""

        topics: Sequence[string]
        types: Sequence[string]
        typedefs_full_text: Sequence[string]


class TopicsForType(Service):
    """List the topics of a type."""

    class Request(Message):
        """The type's name."""

        type: string

    class Response(Message):
        """Names of the topics."""

        topics: Sequence[string]


class TopicType(Service):
    """Return a topic's type."""

    class Request(Message):
        """The topic's name."""

        topic: string

    class Response(Message):
        """The type, empty if there is no such topic."""

        type: string


class Publishers(Service):
    """List the nodes that publish a topic."""

    class Request(Message):
        """The topic's name."""

        topic: string

    class Response(Message):
        """Names of the nodes."""

        publishers: Sequence[string]


class Subscribers(Service):
    """List the nodes that subscribe to a topic."""

    class Request(Message):
        """The topic's name."""

        topic: string

    class Response(Message):
        """Names of the nodes."""

        subscribers: Sequence[string]


class Services(Service):
    """List the services."""

    class Request(Message):
        """Nothing."""

    class Response(Message):
        """Names of the services."""

        services: Sequence[string]


class ServicesForType(Service):
    """List the services of a type."""

    class Request(Message):
        """The type's name."""

        type: string

    class Response(Message):
        """Names of the services."""

        services: Sequence[string]


class ServiceType(Service):
    """Return a service's type."""

    class Request(Message):
        """The service's name."""

        service: string

    class Response(Message):
        """The type, empty if there is no such service."""

        type: string


class ServiceNode(Service):
    """Return the node that has a service."""

    class Request(Message):
        """The service's name."""

        service: string

    class Response(Message):
        """The node's name."""

        node: string


class ServiceProviders(Service):
    """List the nodes that have a service."""

    class Request(Message):
        """The service's name."""

        service: string

    class Response(Message):
        """Names of the nodes."""

        providers: Sequence[string]


class ServiceRequestDetails(Service):
    """Return the definition of a service's request."""

    class Request(Message):
        """The service type's name."""

        type: string

    class Response(Message):
        """Definitions of the request and of all types in it."""

        typedefs: Sequence[TypeDef]


class ServiceResponseDetails(Service):
    """Return the definition of a service's response."""

    class Request(Message):
        """The service type's name."""

        type: string

    class Response(Message):
        """Definitions of the response and of all types in it."""

        typedefs: Sequence[TypeDef]


class MessageDetails(Service):
    """Return the definition of a message."""

    class Request(Message):
        """The message type's name."""

        type: string

    class Response(Message):
        """Definitions of the message and of all types in it."""

        typedefs: Sequence[TypeDef]


class GetActionServers(Service):
    """List the actions that are served."""

    class Request(Message):
        """Nothing."""

    class Response(Message):
        """Names of the actions."""

        action_servers: Sequence[string]


class ActionType(Service):
    """Return an action's type."""

    class Request(Message):
        """The action's name."""

        action: string

    class Response(Message):
        """The type, empty if there is no such action."""

        type: string


class Interfaces(Service):
    """List the types that are installed."""

    class Request(Message):
        """Nothing."""

    class Response(Message):
        """Names of the types."""

        interfaces: Sequence[string]


class Nodes(Service):
    """List the nodes."""

    class Request(Message):
        """Nothing."""

    class Response(Message):
        """Names of the nodes."""

        nodes: Sequence[string]


class NodeDetails(Service):
    """Return what a node uses."""

    class Request(Message):
        """The node's name."""

        node: string

    class Response(Message):
        """Topics that it subscribes to, topics that it publishes, and its services."""

        subscribing: Sequence[string]
        publishing: Sequence[string]
        services: Sequence[string]


class GetTime(Service):
    """Return the present ROS time."""

    class Request(Message):
        """Nothing."""

    class Response(Message):
        """The time."""

        time: Time


class GetROSVersion(Service):
    """Return ROS's version."""

    class Request(Message):
        """Nothing."""

    class Response(Message):
        """1 or 2, and the name of the distribution."""

        version: uint8
        distro: string


class GetParamNames(Service):
    """List the parameters of all nodes."""

    class Request(Message):
        """Nothing."""

    class Response(Message):
        """Names as NODE:PARAMETER."""

        names: Sequence[string]


class HasParam(Service):
    """Return whether there is a parameter."""

    class Request(Message):
        """Name as NODE:PARAMETER."""

        name: string

    class Response(Message):
        """True if there is one."""

        exists: bool


class GetParam(Service):
    """Return a parameter's value."""

    class Request(Message):
        """Name as NODE:PARAMETER, and the JSON text to return if it is not set."""

        name: string
        default_value: string

    class Response(Message):
        """The value as a JSON text."""

        value: string


class SetParam(Service):
    """Set a parameter."""

    class Request(Message):
        """Name as NODE:PARAMETER, and the value as a JSON text."""

        name: string
        value: string

    class Response(Message):
        """Nothing."""


class DeleteParam(Service):
    """Remove a parameter."""

    class Request(Message):
        """Name as NODE:PARAMETER."""

        name: string

    class Response(Message):
        """Nothing."""
