"""The service of visualization_msgs: all interactive markers, for a client that has just come."""

from robolink.interfaces.visualization_msgs.msg import InteractiveMarker
from robolink.message import Message, Sequence, Service, uint64


class GetInteractiveMarkers(Service):
    """Ask a server for all its interactive markers."""

    class Request(Message):
        """Nothing."""

    class Response(Message):
        """All markers, and the number of the last update that they contain."""

        sequence_number: uint64
        markers: Sequence[InteractiveMarker]
