"""The messages of rmw_dds_common: what ROS 2 over DDS tells of its nodes on ros_discovery_info, as old bags hold it."""

from typing import Annotated

from robolink.message import AtMost, Message, Sequence, Size, char, string


class Gid(Message):
    """An endpoint's or a participant's identifier."""

    data: Annotated[Sequence[char], Size(16)]


class NodeEntitiesInfo(Message):
    """A node, and what it reads from and writes to."""

    node_namespace: Annotated[string, AtMost(256)]
    node_name: Annotated[string, AtMost(256)]
    reader_gid_seq: Sequence[Gid]
    writer_gid_seq: Sequence[Gid]


class ParticipantEntitiesInfo(Message):
    """All nodes of one DDS participant."""

    gid: Gid
    node_entities_info_seq: Sequence[NodeEntitiesInfo]
