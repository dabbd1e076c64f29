"""The service of type_description_interfaces: asking a node what a type is made of."""

from robolink.interfaces.type_description_interfaces.msg import KeyValue, TypeDescription, TypeSource
from robolink.message import Message, Sequence, Service, string


class GetTypeDescription(Service):
    """Ask a node, at its service ``~/get_type_description``, for a type that it uses."""

    class Request(Message):
        """Which type: its name (``geometry_msgs/msg/Twist``), and its RIHS hash where the version matters.

        `include_type_sources` asks for the text of the files as well.
        """

        type_name: string
        type_hash: string
        include_type_sources: bool = True

    class Response(Message):
        """The description; it only counts when `successful` is true, otherwise `failure_reason` says what is amiss.

        `type_sources` has the type's own file and those of all types that it is made of; `extra_information` is
        whatever else the node wants to tell.
        """

        successful: bool
        failure_reason: string
        type_description: TypeDescription
        type_sources: Sequence[TypeSource]
        extra_information: Sequence[KeyValue]
