"""The messages of octomap_msgs: octrees."""

from robolink.interfaces.geometry_msgs.msg import Pose
from robolink.interfaces.std_msgs.msg import Header
from robolink.message import Message, Sequence, float64, int8, string


class Octomap(Message):
    """An octree as OctoMap writes it, and the side of its smallest cell in metres.

    `binary` trees only know free and occupied; `id` is the kind of tree.
    """

    header: Header
    binary: bool
    id: string
    resolution: float64
    data: Sequence[int8]


class OctomapWithPose(Message):
    """An octree and the pose of its origin."""

    header: Header
    origin: Pose
    octomap: Octomap
