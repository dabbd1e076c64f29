"""MCAP files: a writer whose file is valid at every moment, a reader that also reads broken ones, and their repair.

>>> writer = Writer(path)
>>> channel = writer.add_channel(writer.add_schema("std_msgs/msg/String", "ros2msg", b"string data"), "/chatter", "cdr")
>>> writer.write(channel, log_time, publish_time, 0, data)  # in nanoseconds
>>> writer.close()

The format is that of https://mcap.dev/spec. What this room knows of ROS is one word: its profile.
"""

from robolink.bag.mcap.chunk import MissingCompressionError
from robolink.bag.mcap.reader import Reader, open_mcap
from robolink.bag.mcap.records import Attachment, Channel, McapError, Message, Schema, Statistics
from robolink.bag.mcap.reindexing import Report, reindex
from robolink.bag.mcap.writer import Writer

__all__ = [
    "Attachment",
    "Channel",
    "McapError",
    "Message",
    "MissingCompressionError",
    "Reader",
    "Report",
    "Schema",
    "Statistics",
    "Writer",
    "open_mcap",
    "reindex",
]
