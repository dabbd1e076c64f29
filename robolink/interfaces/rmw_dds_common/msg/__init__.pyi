# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message
import robolink.interfaces.rmw_dds_common.msg

__all__ = ["Gid", "NodeEntitiesInfo", "ParticipantEntitiesInfo"]

class Gid(robolink.message.Message):
    """An endpoint's or a participant's identifier."""
    data: collections.abc.MutableSequence[builtins.int]
    def __init__(self, *, data: collections.abc.Iterable[builtins.int] = ...) -> None: ...
class NodeEntitiesInfo(robolink.message.Message):
    """A node, and what it reads from and writes to."""
    node_namespace: builtins.str
    node_name: builtins.str
    reader_gid_seq: collections.abc.MutableSequence[robolink.interfaces.rmw_dds_common.msg.Gid]
    writer_gid_seq: collections.abc.MutableSequence[robolink.interfaces.rmw_dds_common.msg.Gid]
    def __init__(self, *, node_namespace: builtins.str = ..., node_name: builtins.str = ..., reader_gid_seq: collections.abc.Iterable[robolink.interfaces.rmw_dds_common.msg.Gid] = ..., writer_gid_seq: collections.abc.Iterable[robolink.interfaces.rmw_dds_common.msg.Gid] = ...) -> None: ...
class ParticipantEntitiesInfo(robolink.message.Message):
    """All nodes of one DDS participant."""
    gid: robolink.interfaces.rmw_dds_common.msg.Gid
    node_entities_info_seq: collections.abc.MutableSequence[robolink.interfaces.rmw_dds_common.msg.NodeEntitiesInfo]
    def __init__(self, *, gid: robolink.interfaces.rmw_dds_common.msg.Gid = ..., node_entities_info_seq: collections.abc.Iterable[robolink.interfaces.rmw_dds_common.msg.NodeEntitiesInfo] = ...) -> None: ...
