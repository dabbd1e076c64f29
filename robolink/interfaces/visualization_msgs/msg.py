"""The messages of visualization_msgs: what rviz shows, and what one can drag there."""

from typing import ClassVar

from robolink.interfaces.builtin_interfaces.msg import Duration
from robolink.interfaces.geometry_msgs.msg import Point, Pose, Quaternion, Vector3
from robolink.interfaces.sensor_msgs.msg import CompressedImage
from robolink.interfaces.std_msgs.msg import ColorRGBA, Header
from robolink.message import Message, Sequence, float32, int32, string, uint8, uint32, uint64


class UVCoordinate(Message):
    """A place in a texture: shares of its width (`u`) and height (`v`), from 0.0 to 1.0."""

    u: float32
    v: float32


class MeshFile(Message):
    """A mesh, as the bytes of its file; the ending of `filename` says of what format."""

    filename: string
    data: Sequence[uint8]


class Marker(Message):
    """A shape that rviz shows, at `pose` in the frame of the header.

    `ns` and `id` together name the shape: another message of the same name changes it (action ADD or MODIFY, which
    are the same) or removes it (DELETE; DELETEALL removes all). `scale` is in metres: the size of CUBE, SPHERE and
    CYLINDER; the length, width and height of an ARROW; the width of lines in x; the height of letters in z. `color`
    needs an alpha above 0 to be seen. A `lifetime` of zero is for ever. With `frame_locked` the shape moves along
    with its frame.

    `points`, in metres and relative to `pose`, are what lists, strips, points and triangles are made of (an ARROW may
    have a start and an end); `colors` has one for each of them, or none. The texture fields are for TRIANGLE_LIST and
    MESH_RESOURCE, with one of `uv_coordinates` for each point; `text` is for TEXT_VIEW_FACING. `mesh_resource` and
    `texture_resource` are addresses (``package://...``, ``file://...``), or ``embedded://NAME`` for what the message
    itself carries in `mesh_file` and `texture`.
    """

    ARROW: ClassVar[int32] = 0
    CUBE: ClassVar[int32] = 1
    SPHERE: ClassVar[int32] = 2
    CYLINDER: ClassVar[int32] = 3
    LINE_STRIP: ClassVar[int32] = 4
    LINE_LIST: ClassVar[int32] = 5
    CUBE_LIST: ClassVar[int32] = 6
    SPHERE_LIST: ClassVar[int32] = 7
    POINTS: ClassVar[int32] = 8
    TEXT_VIEW_FACING: ClassVar[int32] = 9
    MESH_RESOURCE: ClassVar[int32] = 10
    TRIANGLE_LIST: ClassVar[int32] = 11
    ARROW_STRIP: ClassVar[int32] = 12
    ADD: ClassVar[int32] = 0
    MODIFY: ClassVar[int32] = 0
    DELETE: ClassVar[int32] = 2
    DELETEALL: ClassVar[int32] = 3

    header: Header
    ns: string
    id: int32
    type: int32
    action: int32
    pose: Pose
    scale: Vector3
    color: ColorRGBA
    lifetime: Duration
    frame_locked: bool
    points: Sequence[Point]
    colors: Sequence[ColorRGBA]
    texture_resource: string
    texture: CompressedImage
    uv_coordinates: Sequence[UVCoordinate]
    text: string
    mesh_resource: string
    mesh_file: MeshFile
    mesh_use_embedded_materials: bool


class MarkerArray(Message):
    """Several markers at once."""

    markers: Sequence[Marker]


class ImageMarker(Message):
    """A drawing on top of an image; places and lengths are in pixels.

    `ns` and `id` together name the drawing. A CIRCLE is at `position` with `scale` as its diameter; the other types
    use `points`, and one of `outline_colors` for each of them. It is filled with `fill_color` when `filled` is not 0.
    A `lifetime` of zero is for ever.
    """

    CIRCLE: ClassVar[int32] = 0
    LINE_STRIP: ClassVar[int32] = 1
    LINE_LIST: ClassVar[int32] = 2
    POLYGON: ClassVar[int32] = 3
    POINTS: ClassVar[int32] = 4
    ADD: ClassVar[int32] = 0
    REMOVE: ClassVar[int32] = 1

    header: Header
    ns: string
    id: int32
    type: int32
    action: int32
    position: Point
    scale: float32
    outline_color: ColorRGBA
    filled: uint8
    fill_color: ColorRGBA
    lifetime: Duration
    points: Sequence[Point]
    outline_colors: Sequence[ColorRGBA]


class MenuEntry(Message):
    """One line of the menu of an interactive marker.

    Entries come in one list, in the order in which they are shown. `id` is never 0; `parent_id` is the entry whose
    submenu this one belongs to, and 0 on the first level. A parent comes before its children. A click on an entry of
    the type FEEDBACK is reported in an InteractiveMarkerFeedback; the other two types run `command` with ROS 1's
    rosrun and roslaunch.
    """

    FEEDBACK: ClassVar[uint8] = 0
    ROSRUN: ClassVar[uint8] = 1
    ROSLAUNCH: ClassVar[uint8] = 2

    id: uint32
    parent_id: uint32
    title: string
    command: string
    command_type: uint8


class InteractiveMarkerControl(Message):
    """One handle of an interactive marker: how it looks, and what dragging it does.

    `orientation` turns the axes along which the handle works, relative to the marker. INHERIT: they follow the
    marker; FIXED: they stay as they were; VIEW_FACING: their y-z plane faces the user. NONE shows only, MENU opens
    the menu at a right click, BUTTON is clicked. MOVE_AXIS and ROTATE_AXIS work along and around x, MOVE_PLANE in the
    y-z plane, MOVE_ROTATE is the last two together; the 3D modes move and turn freely.

    `markers` are shown instead of rviz's own arrows and rings; a marker without a frame is relative to the
    interactive marker. In VIEW_FACING mode `independent_marker_orientation` keeps them from turning with the view.
    `always_visible` shows them even when nothing can be dragged. `name` is needed for feedback; `description` has up
    to 40 characters.
    """

    INHERIT: ClassVar[uint8] = 0
    FIXED: ClassVar[uint8] = 1
    VIEW_FACING: ClassVar[uint8] = 2
    NONE: ClassVar[uint8] = 0
    MENU: ClassVar[uint8] = 1
    BUTTON: ClassVar[uint8] = 2
    MOVE_AXIS: ClassVar[uint8] = 3
    MOVE_PLANE: ClassVar[uint8] = 4
    ROTATE_AXIS: ClassVar[uint8] = 5
    MOVE_ROTATE: ClassVar[uint8] = 6
    MOVE_3D: ClassVar[uint8] = 7
    ROTATE_3D: ClassVar[uint8] = 8
    MOVE_ROTATE_3D: ClassVar[uint8] = 9

    name: string
    orientation: Quaternion
    orientation_mode: uint8
    interaction_mode: uint8
    always_visible: bool
    markers: Sequence[Marker]
    independent_marker_orientation: bool
    description: string


class InteractiveMarker(Message):
    """Something in rviz that can be dragged, turned and clicked.

    A header stamp of zero ties it to its frame; otherwise it stays where the frame was at that time. `pose` is where
    it is and what it turns about. `name` is its own on this topic; `description`, up to 40 characters, is shown
    above. `scale` is the size of handles in metres, 1.0 by default.
    """

    header: Header
    pose: Pose
    name: string
    description: string
    scale: float32
    menu_entries: Sequence[MenuEntry]
    controls: Sequence[InteractiveMarkerControl]


class InteractiveMarkerPose(Message):
    """A new pose for the interactive marker of that name."""

    header: Header
    pose: Pose
    name: string


class InteractiveMarkerInit(Message):
    """All interactive markers of a server, for clients that have just come.

    `seq_num` is that of the last update, so that a client sees whether it has missed one.
    """

    server_id: string
    seq_num: uint64
    markers: Sequence[InteractiveMarker]


class InteractiveMarkerUpdate(Message):
    """Changes on a server of interactive markers.

    With type UPDATE, `seq_num` is one more than before; `markers` are new or changed, `poses` are of markers that
    only moved, `erases` names those that went. KEEP_ALIVE says that the server is there: the number stays and the
    lists are empty.
    """

    KEEP_ALIVE: ClassVar[uint8] = 0
    UPDATE: ClassVar[uint8] = 1

    server_id: string
    seq_num: uint64
    type: uint8
    markers: Sequence[InteractiveMarker]
    poses: Sequence[InteractiveMarkerPose]
    erases: Sequence[string]


class InteractiveMarkerFeedback(Message):
    """Action of a user on an interactive marker, as rviz reports it.

    POSE_UPDATE: it was dragged and is now at `pose`, which is valid in all feedback. KEEP_ALIVE: it is being held.
    MENU_SELECT: `menu_entry_id` was chosen. BUTTON_CLICK, MOUSE_DOWN, MOUSE_UP: at `mouse_point`, in metres in the
    frame of the header, if `mouse_point_valid`. `client_id` is the rviz that reports.
    """

    KEEP_ALIVE: ClassVar[uint8] = 0
    POSE_UPDATE: ClassVar[uint8] = 1
    MENU_SELECT: ClassVar[uint8] = 2
    BUTTON_CLICK: ClassVar[uint8] = 3
    MOUSE_DOWN: ClassVar[uint8] = 4
    MOUSE_UP: ClassVar[uint8] = 5

    header: Header
    client_id: string
    marker_name: string
    control_name: string
    event_type: uint8
    pose: Pose
    menu_entry_id: uint32
    mouse_point: Point
    mouse_point_valid: bool
