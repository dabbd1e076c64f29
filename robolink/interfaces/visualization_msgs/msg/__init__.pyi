# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message
import robolink.interfaces.builtin_interfaces.msg
import robolink.interfaces.geometry_msgs.msg
import robolink.interfaces.sensor_msgs.msg
import robolink.interfaces.std_msgs.msg
import robolink.interfaces.visualization_msgs.msg

__all__ = ["ImageMarker", "InteractiveMarker", "InteractiveMarkerControl", "InteractiveMarkerFeedback", "InteractiveMarkerInit", "InteractiveMarkerPose", "InteractiveMarkerUpdate", "Marker", "MarkerArray", "MenuEntry", "MeshFile", "UVCoordinate"]

class ImageMarker(robolink.message.Message):
    """A drawing on top of an image; places and lengths are in pixels.

    `ns` and `id` together name the drawing. A CIRCLE is at `position` with `scale` as its diameter; the other types
    use `points`, and one of `outline_colors` for each of them. It is filled with `fill_color` when `filled` is not 0.
    A `lifetime` of zero is for ever.
    """
    CIRCLE: typing.ClassVar[builtins.int]
    LINE_STRIP: typing.ClassVar[builtins.int]
    LINE_LIST: typing.ClassVar[builtins.int]
    POLYGON: typing.ClassVar[builtins.int]
    POINTS: typing.ClassVar[builtins.int]
    ADD: typing.ClassVar[builtins.int]
    REMOVE: typing.ClassVar[builtins.int]
    header: robolink.interfaces.std_msgs.msg.Header
    ns: builtins.str
    id: builtins.int
    type: builtins.int
    action: builtins.int
    position: robolink.interfaces.geometry_msgs.msg.Point
    scale: builtins.float
    outline_color: robolink.interfaces.std_msgs.msg.ColorRGBA
    filled: builtins.int
    fill_color: robolink.interfaces.std_msgs.msg.ColorRGBA
    lifetime: robolink.interfaces.builtin_interfaces.msg.Duration
    points: collections.abc.MutableSequence[robolink.interfaces.geometry_msgs.msg.Point]
    outline_colors: collections.abc.MutableSequence[robolink.interfaces.std_msgs.msg.ColorRGBA]
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., ns: builtins.str = ..., id: builtins.int = ..., type: builtins.int = ..., action: builtins.int = ..., position: robolink.interfaces.geometry_msgs.msg.Point = ..., scale: builtins.float = ..., outline_color: robolink.interfaces.std_msgs.msg.ColorRGBA = ..., filled: builtins.int = ..., fill_color: robolink.interfaces.std_msgs.msg.ColorRGBA = ..., lifetime: robolink.interfaces.builtin_interfaces.msg.Duration = ..., points: collections.abc.Iterable[robolink.interfaces.geometry_msgs.msg.Point] = ..., outline_colors: collections.abc.Iterable[robolink.interfaces.std_msgs.msg.ColorRGBA] = ...) -> None: ...
class InteractiveMarker(robolink.message.Message):
    """Something in rviz that can be dragged, turned and clicked.

    A header stamp of zero ties it to its frame; otherwise it stays where the frame was at that time. `pose` is where
    it is and what it turns about. `name` is its own on this topic; `description`, up to 40 characters, is shown
    above. `scale` is the size of handles in metres, 1.0 by default.
    """
    header: robolink.interfaces.std_msgs.msg.Header
    pose: robolink.interfaces.geometry_msgs.msg.Pose
    name: builtins.str
    description: builtins.str
    scale: builtins.float
    menu_entries: collections.abc.MutableSequence[robolink.interfaces.visualization_msgs.msg.MenuEntry]
    controls: collections.abc.MutableSequence[robolink.interfaces.visualization_msgs.msg.InteractiveMarkerControl]
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., pose: robolink.interfaces.geometry_msgs.msg.Pose = ..., name: builtins.str = ..., description: builtins.str = ..., scale: builtins.float = ..., menu_entries: collections.abc.Iterable[robolink.interfaces.visualization_msgs.msg.MenuEntry] = ..., controls: collections.abc.Iterable[robolink.interfaces.visualization_msgs.msg.InteractiveMarkerControl] = ...) -> None: ...
class InteractiveMarkerControl(robolink.message.Message):
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
    INHERIT: typing.ClassVar[builtins.int]
    FIXED: typing.ClassVar[builtins.int]
    VIEW_FACING: typing.ClassVar[builtins.int]
    NONE: typing.ClassVar[builtins.int]
    MENU: typing.ClassVar[builtins.int]
    BUTTON: typing.ClassVar[builtins.int]
    MOVE_AXIS: typing.ClassVar[builtins.int]
    MOVE_PLANE: typing.ClassVar[builtins.int]
    ROTATE_AXIS: typing.ClassVar[builtins.int]
    MOVE_ROTATE: typing.ClassVar[builtins.int]
    MOVE_3D: typing.ClassVar[builtins.int]
    ROTATE_3D: typing.ClassVar[builtins.int]
    MOVE_ROTATE_3D: typing.ClassVar[builtins.int]
    name: builtins.str
    orientation: robolink.interfaces.geometry_msgs.msg.Quaternion
    orientation_mode: builtins.int
    interaction_mode: builtins.int
    always_visible: builtins.bool
    markers: collections.abc.MutableSequence[robolink.interfaces.visualization_msgs.msg.Marker]
    independent_marker_orientation: builtins.bool
    description: builtins.str
    def __init__(self, *, name: builtins.str = ..., orientation: robolink.interfaces.geometry_msgs.msg.Quaternion = ..., orientation_mode: builtins.int = ..., interaction_mode: builtins.int = ..., always_visible: builtins.bool = ..., markers: collections.abc.Iterable[robolink.interfaces.visualization_msgs.msg.Marker] = ..., independent_marker_orientation: builtins.bool = ..., description: builtins.str = ...) -> None: ...
class InteractiveMarkerFeedback(robolink.message.Message):
    """Action of a user on an interactive marker, as rviz reports it.

    POSE_UPDATE: it was dragged and is now at `pose`, which is valid in all feedback. KEEP_ALIVE: it is being held.
    MENU_SELECT: `menu_entry_id` was chosen. BUTTON_CLICK, MOUSE_DOWN, MOUSE_UP: at `mouse_point`, in metres in the
    frame of the header, if `mouse_point_valid`. `client_id` is the rviz that reports.
    """
    KEEP_ALIVE: typing.ClassVar[builtins.int]
    POSE_UPDATE: typing.ClassVar[builtins.int]
    MENU_SELECT: typing.ClassVar[builtins.int]
    BUTTON_CLICK: typing.ClassVar[builtins.int]
    MOUSE_DOWN: typing.ClassVar[builtins.int]
    MOUSE_UP: typing.ClassVar[builtins.int]
    header: robolink.interfaces.std_msgs.msg.Header
    client_id: builtins.str
    marker_name: builtins.str
    control_name: builtins.str
    event_type: builtins.int
    pose: robolink.interfaces.geometry_msgs.msg.Pose
    menu_entry_id: builtins.int
    mouse_point: robolink.interfaces.geometry_msgs.msg.Point
    mouse_point_valid: builtins.bool
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., client_id: builtins.str = ..., marker_name: builtins.str = ..., control_name: builtins.str = ..., event_type: builtins.int = ..., pose: robolink.interfaces.geometry_msgs.msg.Pose = ..., menu_entry_id: builtins.int = ..., mouse_point: robolink.interfaces.geometry_msgs.msg.Point = ..., mouse_point_valid: builtins.bool = ...) -> None: ...
class InteractiveMarkerInit(robolink.message.Message):
    """All interactive markers of a server, for clients that have just come.

    `seq_num` is that of the last update, so that a client sees whether it has missed one.
    """
    server_id: builtins.str
    seq_num: builtins.int
    markers: collections.abc.MutableSequence[robolink.interfaces.visualization_msgs.msg.InteractiveMarker]
    def __init__(self, *, server_id: builtins.str = ..., seq_num: builtins.int = ..., markers: collections.abc.Iterable[robolink.interfaces.visualization_msgs.msg.InteractiveMarker] = ...) -> None: ...
class InteractiveMarkerPose(robolink.message.Message):
    """A new pose for the interactive marker of that name."""
    header: robolink.interfaces.std_msgs.msg.Header
    pose: robolink.interfaces.geometry_msgs.msg.Pose
    name: builtins.str
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., pose: robolink.interfaces.geometry_msgs.msg.Pose = ..., name: builtins.str = ...) -> None: ...
class InteractiveMarkerUpdate(robolink.message.Message):
    """Changes on a server of interactive markers.

    With type UPDATE, `seq_num` is one more than before; `markers` are new or changed, `poses` are of markers that
    only moved, `erases` names those that went. KEEP_ALIVE says that the server is there: the number stays and the
    lists are empty.
    """
    KEEP_ALIVE: typing.ClassVar[builtins.int]
    UPDATE: typing.ClassVar[builtins.int]
    server_id: builtins.str
    seq_num: builtins.int
    type: builtins.int
    markers: collections.abc.MutableSequence[robolink.interfaces.visualization_msgs.msg.InteractiveMarker]
    poses: collections.abc.MutableSequence[robolink.interfaces.visualization_msgs.msg.InteractiveMarkerPose]
    erases: collections.abc.MutableSequence[builtins.str]
    def __init__(self, *, server_id: builtins.str = ..., seq_num: builtins.int = ..., type: builtins.int = ..., markers: collections.abc.Iterable[robolink.interfaces.visualization_msgs.msg.InteractiveMarker] = ..., poses: collections.abc.Iterable[robolink.interfaces.visualization_msgs.msg.InteractiveMarkerPose] = ..., erases: collections.abc.Iterable[builtins.str] = ...) -> None: ...
class Marker(robolink.message.Message):
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
    ARROW: typing.ClassVar[builtins.int]
    CUBE: typing.ClassVar[builtins.int]
    SPHERE: typing.ClassVar[builtins.int]
    CYLINDER: typing.ClassVar[builtins.int]
    LINE_STRIP: typing.ClassVar[builtins.int]
    LINE_LIST: typing.ClassVar[builtins.int]
    CUBE_LIST: typing.ClassVar[builtins.int]
    SPHERE_LIST: typing.ClassVar[builtins.int]
    POINTS: typing.ClassVar[builtins.int]
    TEXT_VIEW_FACING: typing.ClassVar[builtins.int]
    MESH_RESOURCE: typing.ClassVar[builtins.int]
    TRIANGLE_LIST: typing.ClassVar[builtins.int]
    ARROW_STRIP: typing.ClassVar[builtins.int]
    ADD: typing.ClassVar[builtins.int]
    MODIFY: typing.ClassVar[builtins.int]
    DELETE: typing.ClassVar[builtins.int]
    DELETEALL: typing.ClassVar[builtins.int]
    header: robolink.interfaces.std_msgs.msg.Header
    ns: builtins.str
    id: builtins.int
    type: builtins.int
    action: builtins.int
    pose: robolink.interfaces.geometry_msgs.msg.Pose
    scale: robolink.interfaces.geometry_msgs.msg.Vector3
    color: robolink.interfaces.std_msgs.msg.ColorRGBA
    lifetime: robolink.interfaces.builtin_interfaces.msg.Duration
    frame_locked: builtins.bool
    points: collections.abc.MutableSequence[robolink.interfaces.geometry_msgs.msg.Point]
    colors: collections.abc.MutableSequence[robolink.interfaces.std_msgs.msg.ColorRGBA]
    texture_resource: builtins.str
    texture: robolink.interfaces.sensor_msgs.msg.CompressedImage
    uv_coordinates: collections.abc.MutableSequence[robolink.interfaces.visualization_msgs.msg.UVCoordinate]
    text: builtins.str
    mesh_resource: builtins.str
    mesh_file: robolink.interfaces.visualization_msgs.msg.MeshFile
    mesh_use_embedded_materials: builtins.bool
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., ns: builtins.str = ..., id: builtins.int = ..., type: builtins.int = ..., action: builtins.int = ..., pose: robolink.interfaces.geometry_msgs.msg.Pose = ..., scale: robolink.interfaces.geometry_msgs.msg.Vector3 = ..., color: robolink.interfaces.std_msgs.msg.ColorRGBA = ..., lifetime: robolink.interfaces.builtin_interfaces.msg.Duration = ..., frame_locked: builtins.bool = ..., points: collections.abc.Iterable[robolink.interfaces.geometry_msgs.msg.Point] = ..., colors: collections.abc.Iterable[robolink.interfaces.std_msgs.msg.ColorRGBA] = ..., texture_resource: builtins.str = ..., texture: robolink.interfaces.sensor_msgs.msg.CompressedImage = ..., uv_coordinates: collections.abc.Iterable[robolink.interfaces.visualization_msgs.msg.UVCoordinate] = ..., text: builtins.str = ..., mesh_resource: builtins.str = ..., mesh_file: robolink.interfaces.visualization_msgs.msg.MeshFile = ..., mesh_use_embedded_materials: builtins.bool = ...) -> None: ...
class MarkerArray(robolink.message.Message):
    """Several markers at once."""
    markers: collections.abc.MutableSequence[robolink.interfaces.visualization_msgs.msg.Marker]
    def __init__(self, *, markers: collections.abc.Iterable[robolink.interfaces.visualization_msgs.msg.Marker] = ...) -> None: ...
class MenuEntry(robolink.message.Message):
    """One line of the menu of an interactive marker.

    Entries come in one list, in the order in which they are shown. `id` is never 0; `parent_id` is the entry whose
    submenu this one belongs to, and 0 on the first level. A parent comes before its children. A click on an entry of
    the type FEEDBACK is reported in an InteractiveMarkerFeedback; the other two types run `command` with ROS 1's
    rosrun and roslaunch.
    """
    FEEDBACK: typing.ClassVar[builtins.int]
    ROSRUN: typing.ClassVar[builtins.int]
    ROSLAUNCH: typing.ClassVar[builtins.int]
    id: builtins.int
    parent_id: builtins.int
    title: builtins.str
    command: builtins.str
    command_type: builtins.int
    def __init__(self, *, id: builtins.int = ..., parent_id: builtins.int = ..., title: builtins.str = ..., command: builtins.str = ..., command_type: builtins.int = ...) -> None: ...
class MeshFile(robolink.message.Message):
    """A mesh, as the bytes of its file; the ending of `filename` says of what format."""
    filename: builtins.str
    data: collections.abc.MutableSequence[builtins.int]
    def __init__(self, *, filename: builtins.str = ..., data: collections.abc.Iterable[builtins.int] = ...) -> None: ...
class UVCoordinate(robolink.message.Message):
    """A place in a texture: shares of its width (`u`) and height (`v`), from 0.0 to 1.0."""
    u: builtins.float
    v: builtins.float
    def __init__(self, *, u: builtins.float = ..., v: builtins.float = ...) -> None: ...
