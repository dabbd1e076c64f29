"""The messages of rosbag2_interfaces: a bag goes on in its next file."""

from robolink.message import Message, string


class ReadSplitEvent(Message):
    """A player has finished one file of a bag and opened the next: both paths, and the player's node."""

    closed_file: string
    opened_file: string
    node_name: string


class WriteSplitEvent(Message):
    """A recorder has closed one file of a bag and begun the next: both paths, and the recorder's node."""

    closed_file: string
    opened_file: string
    node_name: string
