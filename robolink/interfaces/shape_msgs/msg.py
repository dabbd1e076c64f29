"""The messages of shape_msgs: solid bodies, meshes and planes, in metres."""

from typing import Annotated, ClassVar

from robolink.interfaces.geometry_msgs.msg import Point, Polygon
from robolink.message import AtMost, Message, Sequence, Size, float64, uint8, uint32


class MeshTriangle(Message):
    """One triangle of a mesh: the indices of its three corners in the mesh's `vertices`."""

    vertex_indices: Annotated[Sequence[uint32], Size(3)]


class Mesh(Message):
    """A surface made of triangles, whose corners are points in metres."""

    triangles: Sequence[MeshTriangle]
    vertices: Sequence[Point]


class Plane(Message):
    """The plane of all points with ``a·x + b·y + c·z + d = 0``; `coef` is a, b, c and d."""

    coef: Annotated[Sequence[float64], Size(4)]


class SolidPrimitive(Message):
    """A simple solid body, centred on the origin of its frame; lengths are in metres.

    `type` says what `dimensions` are, and the constants of the same name at which index each stands: the three sides
    of a BOX, the radius of a SPHERE, height and radius of a CYLINDER or CONE (their axis is z, a cone's tip points
    up), the height of a PRISM. A prism's base is `polygon`, its corners in counter-clockwise order, x and y only; it
    reaches half of the height up and down.
    """

    BOX: ClassVar[uint8] = 1
    SPHERE: ClassVar[uint8] = 2
    CYLINDER: ClassVar[uint8] = 3
    CONE: ClassVar[uint8] = 4
    PRISM: ClassVar[uint8] = 5
    BOX_X: ClassVar[uint8] = 0
    BOX_Y: ClassVar[uint8] = 1
    BOX_Z: ClassVar[uint8] = 2
    SPHERE_RADIUS: ClassVar[uint8] = 0
    CYLINDER_HEIGHT: ClassVar[uint8] = 0
    CYLINDER_RADIUS: ClassVar[uint8] = 1
    CONE_HEIGHT: ClassVar[uint8] = 0
    CONE_RADIUS: ClassVar[uint8] = 1
    PRISM_HEIGHT: ClassVar[uint8] = 0

    type: uint8
    dimensions: Annotated[Sequence[float64], AtMost(3)]
    polygon: Polygon
