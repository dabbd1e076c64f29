"""The services of robot_localization: filters to set and switch, latitudes to convert."""

from typing import Annotated

from robolink.interfaces.builtin_interfaces.msg import Time
from robolink.interfaces.geographic_msgs.msg import GeoPoint, GeoPose
from robolink.interfaces.geometry_msgs.msg import Point, PoseWithCovarianceStamped
from robolink.message import Message, Sequence, Service, Size, float64, string


class FromLL(Service):
    """Convert a position on the Earth to the map."""

    class Request(Message):
        """The position in degrees."""

        ll_point: GeoPoint

    class Response(Message):
        """The position in metres of the map's frame."""

        map_point: Point


class FromLLArray(Service):
    """Convert positions on the Earth to the map."""

    class Request(Message):
        """The positions in degrees."""

        ll_points: Sequence[GeoPoint]

    class Response(Message):
        """The positions in metres of the map's frame."""

        map_points: Sequence[Point]


class ToLL(Service):
    """Convert a position on the map to one on the Earth."""

    class Request(Message):
        """The position in metres of the map's frame."""

        map_point: Point

    class Response(Message):
        """The position in degrees."""

        ll_point: GeoPoint


class ToLLArray(Service):
    """Convert positions on the map to ones on the Earth."""

    class Request(Message):
        """The positions in metres of the map's frame."""

        map_points: Sequence[Point]

    class Response(Message):
        """The positions in degrees."""

        ll_points: Sequence[GeoPoint]


class GetState(Service):
    """Return the filter's state."""

    class Request(Message):
        """The time, and the frame in which to express the state."""

        time_stamp: Time
        frame_id: string

    class Response(Message):
        """State and its covariance, a matrix of 15 rows.

        The state is position, rotation (roll, pitch, yaw), their velocities, and acceleration, in metres, radians and
        seconds.
        """

        state: Annotated[Sequence[float64], Size(15)]
        covariance: Annotated[Sequence[float64], Size(225)]


class SetDatum(Service):
    """Set the position on the Earth of the map's origin."""

    class Request(Message):
        """The position in degrees, and the orientation."""

        geo_pose: GeoPose

    class Response(Message):
        """Nothing."""


class SetPose(Service):
    """Set the filter's pose."""

    class Request(Message):
        """The pose and its uncertainty."""

        pose: PoseWithCovarianceStamped

    class Response(Message):
        """Nothing."""


class SetUTMZone(Service):
    """Set the zone of UTM, the grid in which positions on the Earth are converted."""

    class Request(Message):
        """The zone, such as `31U`."""

        utm_zone: string

    class Response(Message):
        """Nothing."""


class ToggleFilterProcessing(Service):
    """Switch the filter on or off."""

    class Request(Message):
        """True is on."""

        on: bool

    class Response(Message):
        """True if that changed anything."""

        status: bool
