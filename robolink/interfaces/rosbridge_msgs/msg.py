"""The messages of rosbridge_msgs: who is connected to a rosbridge server."""

from robolink.interfaces.builtin_interfaces.msg import Time
from robolink.message import Message, Sequence, string


class ConnectedClient(Message):
    """A client: its address, and since when it is connected."""

    ip_address: string
    connection_time: Time


class ConnectedClients(Message):
    """All clients that are connected."""

    clients: Sequence[ConnectedClient]
