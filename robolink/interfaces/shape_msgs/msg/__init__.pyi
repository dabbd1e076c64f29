# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message
import robolink.interfaces.geometry_msgs.msg
import robolink.interfaces.shape_msgs.msg

__all__ = ["Mesh", "MeshTriangle", "Plane", "SolidPrimitive"]

class Mesh(robolink.message.Message):
    """A surface made of triangles, whose corners are points in metres."""
    triangles: collections.abc.MutableSequence[robolink.interfaces.shape_msgs.msg.MeshTriangle]
    vertices: collections.abc.MutableSequence[robolink.interfaces.geometry_msgs.msg.Point]
    def __init__(self, *, triangles: collections.abc.Iterable[robolink.interfaces.shape_msgs.msg.MeshTriangle] = ..., vertices: collections.abc.Iterable[robolink.interfaces.geometry_msgs.msg.Point] = ...) -> None: ...
class MeshTriangle(robolink.message.Message):
    """One triangle of a mesh: the indices of its three corners in the mesh's `vertices`."""
    vertex_indices: collections.abc.MutableSequence[builtins.int]
    def __init__(self, *, vertex_indices: collections.abc.Iterable[builtins.int] = ...) -> None: ...
class Plane(robolink.message.Message):
    """The plane of all points with ``a·x + b·y + c·z + d = 0``; `coef` is a, b, c and d."""
    coef: collections.abc.MutableSequence[builtins.float]
    def __init__(self, *, coef: collections.abc.Iterable[builtins.float] = ...) -> None: ...
class SolidPrimitive(robolink.message.Message):
    """A simple solid body, centred on the origin of its frame; lengths are in metres.

    `type` says what `dimensions` are, and the constants of the same name at which index each stands: the three sides
    of a BOX, the radius of a SPHERE, height and radius of a CYLINDER or CONE (their axis is z, a cone's tip points
    up), the height of a PRISM. A prism's base is `polygon`, its corners in counter-clockwise order, x and y only; it
    reaches half of the height up and down.
    """
    BOX: typing.ClassVar[builtins.int]
    SPHERE: typing.ClassVar[builtins.int]
    CYLINDER: typing.ClassVar[builtins.int]
    CONE: typing.ClassVar[builtins.int]
    PRISM: typing.ClassVar[builtins.int]
    BOX_X: typing.ClassVar[builtins.int]
    BOX_Y: typing.ClassVar[builtins.int]
    BOX_Z: typing.ClassVar[builtins.int]
    SPHERE_RADIUS: typing.ClassVar[builtins.int]
    CYLINDER_HEIGHT: typing.ClassVar[builtins.int]
    CYLINDER_RADIUS: typing.ClassVar[builtins.int]
    CONE_HEIGHT: typing.ClassVar[builtins.int]
    CONE_RADIUS: typing.ClassVar[builtins.int]
    PRISM_HEIGHT: typing.ClassVar[builtins.int]
    type: builtins.int
    dimensions: collections.abc.MutableSequence[builtins.float]
    polygon: robolink.interfaces.geometry_msgs.msg.Polygon
    def __init__(self, *, type: builtins.int = ..., dimensions: collections.abc.Iterable[builtins.float] = ..., polygon: robolink.interfaces.geometry_msgs.msg.Polygon = ...) -> None: ...
