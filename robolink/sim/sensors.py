"""Sensors as a world file describes them: a Struct for each kind, and the registry of all kinds.

How to add one: "Add a sensor" in docs/development/recipes.md.
"""

from __future__ import annotations

import functools
import importlib
from collections.abc import Iterator
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal, NamedTuple, TypeAlias

from msgspec import Meta, Struct

from robolink.exceptions import RobolinkError
from robolink.extensions import Registry
from robolink.sim.quantities import Length, Pose, Rate, Share

if TYPE_CHECKING:
    from importlib.metadata import EntryPoint

Deviation: TypeAlias = Annotated[float, Meta(ge=0.0, le=100.0)]
Nearest: TypeAlias = Annotated[float, Meta(ge=0.0, le=10_000.0)]
ImageEncoding: TypeAlias = Literal["rgb8", "bgr8", "rgba8", "bgra8", "mono8"]
Bearing: TypeAlias = Annotated[float, Meta(ge=-360.0, le=360.0)]


class Sensor:
    """Base class of all sensors; a sensor's first key is its kind, and the value of that key its topic.

    A key's meaning, for editors, is the `description` of its `Meta`, or that of its name in `schema.MEANINGS`.
    """

    __slots__ = ()
    __struct_fields__: ClassVar[tuple[str, ...]]
    rate: float

    @property
    def kind(self) -> str:
        """The kind of sensor, as a world file spells it: `lidar`, `imu` ..."""
        return self.__struct_fields__[0]

    @property
    def topic(self) -> str:
        """The topic that the sensor publishes on."""
        return str(getattr(self, self.kind))

    @property
    def mount(self) -> Pose | None:
        """The sensor's pose on the robot; None for a sensor that has no place of its own."""
        return getattr(self, "offset", None)

    @property
    def has_frame(self) -> bool:
        """True if a reading is made in a frame: the sensor's own if it has a `mount`, else the robot's base_link."""
        return True

    def problems(self, wheels: int) -> Iterator[tuple[str, str]]:
        """Yield each mistake that types cannot express: its key ('' for the whole sensor), and the reason.

        `wheels` is the number of the robot's wheels.
        """
        return iter(())


class Looking(Sensor):
    """Base class of sensors that see or feel in a sector, `fov` degrees wide."""

    __slots__ = ()
    fov: float

    @property
    def right(self) -> float:
        """The right end of the sector, in degrees from ahead: `start`, by default half of `fov` to the right."""
        start: float | None = getattr(self, "start", None)
        return -self.fov / 2 if start is None else start


class Bumper(Looking, Struct, frozen=True, forbid_unknown_fields=True):
    """A contact sensor on the topic `bumper`: true if something touches the robot within its sector.

    The sector is `fov` degrees wide and begins at `start`, its right end (by default half of `fov` to the right).
    """

    bumper: str
    rate: Rate = 10.0
    fov: Annotated[
        float, Meta(ge=0.01, le=360.0, description="Degrees of the sector that feels; 360 is all round.")
    ] = 360.0
    start: Bearing | None = None


class ImuNoise(Struct, frozen=True, forbid_unknown_fields=True):
    """Standard deviations of a reading: turning in rad/s, acceleration in m/s²."""

    gyro: Annotated[Deviation, Meta(description="Standard deviation in rad/s.")] = 0.0
    accel: Annotated[Deviation, Meta(description="Standard deviation in m/s².")] = 0.0


class Imu(Sensor, Struct, frozen=True, forbid_unknown_fields=True):
    """An inertial measurement unit on the topic `imu`: heading, turning speed, acceleration, in the robot's frame."""

    imu: str
    rate: Rate = 50.0
    noise: Annotated[ImuNoise, Meta(description="Standard deviations of a reading.")] = ImuNoise()


_APERTURE = "Field of view in degrees that messages state; 0 is fov. Webots' sensors of one ray state another."


class RangeFinder(Looking, Struct, frozen=True, forbid_unknown_fields=True):
    """A sonar or infrared sensor on the topic `range_finder`: the distance to the nearest thing within its cone.

    `fov` is in degrees, `range` is [nearest, farthest] in metres, `noise` a standard deviation in metres, `offset`
    its pose on the robot.
    """

    range_finder: str
    rate: Rate = 10.0
    fov: Annotated[float, Meta(ge=0.01, le=180.0)] = 15.0
    range: tuple[Nearest, Length] = (0.02, 4.0)
    noise: Deviation = 0.0
    offset: Pose = Pose(0.0, 0.0, 0.0)
    radiation: Annotated[Literal["ultrasound", "infrared"], Meta(description="Kind of radiation.")] = "ultrasound"
    aperture: Annotated[float, Meta(ge=0.0, le=180.0, description=_APERTURE)] = 0.0

    def problems(self, wheels: int) -> Iterator[tuple[str, str]]:
        """Yield the mistake of an empty range."""
        return _range_problems(self.range)


class Encoders(Sensor, Struct, frozen=True, forbid_unknown_fields=True):
    """Wheel encoders on the topic `encoders`: how far each wheel has turned, in whole `ticks` (0: exactly)."""

    encoders: str
    rate: Rate = 50.0
    ticks: Annotated[int, Meta(ge=0, le=10_000_000, description="Ticks per turn; 0 is exact.")] = 0

    @property
    def has_frame(self) -> bool:
        """False: the joints of wheels are in no frame."""
        return False

    def problems(self, wheels: int) -> Iterator[tuple[str, str]]:
        """Yield the mistake of encoders on a robot without wheels."""
        if not wheels:
            yield "", "encoders count the turns of wheels, and this robot has no 'wheels'"


class Lidar(Looking, Struct, frozen=True, forbid_unknown_fields=True):
    """A planar laser scanner that publishes on the topic `lidar`.

    `fov` and `start` (the first beam; by default half of `fov` to the right) are in degrees, `range` is
    [nearest, farthest] in metres, `noise` a standard deviation in metres, `dropout` the share of beams that get
    no return, `offset` its pose on the robot. A full circle has a beam each 360/beams degrees, so that none is
    doubled; a smaller field of view has a beam at both ends. With `intensities` a scan also tells how much light
    came back: the reflectance of what was hit, times the cosine of the angle at which the beam met it.
    """

    lidar: str
    rate: Rate = 10.0
    beams: Annotated[int, Meta(ge=2, le=100_000, description="Number of beams of a scan.")] = 360
    fov: Annotated[float, Meta(ge=0.01, le=360.0)] = 360.0
    start: Bearing | None = None
    range: tuple[Nearest, Length] = (0.12, 12.0)
    noise: Deviation = 0.0
    dropout: Annotated[Share, Meta(description="Share of beams without a return.")] = 0.0
    offset: Pose = Pose(0.0, 0.0, 0.0)
    intensities: Annotated[bool, Meta(description="True: scans have intensities.")] = False

    def problems(self, wheels: int) -> Iterator[tuple[str, str]]:
        """Yield the mistake of an empty range."""
        return _range_problems(self.range)


class Camera(Sensor, Struct, frozen=True, forbid_unknown_fields=True):
    """A pinhole camera without distortion, on the topics `camera`/image_raw and `camera`/camera_info.

    It stands at `offset` on the robot, `z` metres above the floor, and looks ahead, `pitch` degrees downwards. `fov` is
    horizontal. With `depth` there is a depth image, too, of distances ahead within `range`. The right camera of a
    stereo pair stands `baseline` metres to the right of the left one, whose key is 0.
    """

    camera: str
    rate: Rate = 10.0
    width: Annotated[int, Meta(ge=1, le=4096, description="Columns of an image.")] = 320
    height: Annotated[int, Meta(ge=1, le=4096, description="Rows of an image.")] = 240
    fov: Annotated[float, Meta(ge=1.0, le=170.0, description="Horizontal field of view in degrees.")] = 70.0
    offset: Pose = Pose(0.0, 0.0, 0.0)
    z: Annotated[float, Meta(ge=0.005, le=1000.0, description="Height above the floor in metres.")] = 0.2
    pitch: Annotated[float, Meta(ge=-90.0, le=90.0, description="Degrees by which it looks downwards.")] = 0.0
    noise: Annotated[float, Meta(ge=0.0, le=255.0, description="Standard deviation of colours, of 255.")] = 0.0
    encoding: Annotated[ImageEncoding, Meta(description="Encoding of the image.")] = "rgb8"
    depth: Annotated[bool, Meta(description="True: a depth image, too.")] = False
    range: Annotated[
        tuple[Annotated[float, Meta(ge=0.001, le=10_000.0)], Length],
        Meta(description="Nearest and farthest depth in metres."),
    ] = (0.05, 20.0)
    baseline: Annotated[
        float, Meta(ge=0.0, le=100.0, description="Metres to the left camera, if this is the right one of two.")
    ] = 0.0

    def problems(self, wheels: int) -> Iterator[tuple[str, str]]:
        """Yield the mistake of an empty range."""
        return _range_problems(self.range)


def _range_problems(limits: tuple[float, float]) -> Iterator[tuple[str, str]]:
    near, far = limits
    if near >= far:
        yield "range", f"the nearest, {near:g} m, must be less than the farthest, {far:g} m"


class SensorKind(NamedTuple):
    """A kind of sensor: its keys in a world file, what measures, and what the measurement is sent as.

    Parts are objects, or `MODULE:NAME`, which is imported when the part is used: a world file is read without physics,
    and the simulator knows no messages.
    """

    description: type[Sensor]
    """Struct of the keys; the first is the kind."""
    device: Any
    """Class or function that makes the device of a description and a `Carrier`: see `sensing.devices.Device`."""
    message: Any
    """Message type that it publishes."""
    convert: Any
    """Function that makes the message of a value, a std_msgs Header and the description."""

    def part(self, name: str) -> Any:
        """Return a part, imported if need be.

        Args:
            name: device, message or convert.

        Raises:
            RobolinkError: If it cannot be imported.
        """
        part = getattr(self, name)
        if not isinstance(part, str):
            return part
        try:
            return _attribute(part)
        except (ImportError, AttributeError) as error:
            kind = self.description.__struct_fields__[0]
            reason = f"{type(error).__name__}: {error}"
            raise RobolinkError(f"the sensor '{kind}' cannot load its {name} from {part}: {reason}") from error


@functools.cache
def _attribute(place: str) -> Any:
    module, _, name = place.partition(":")
    return getattr(importlib.import_module(module), name)


def _kind(described: type[Sensor], message: str, convert: str) -> SensorKind:
    return SensorKind(
        described,
        f"robolink.sim.sensing.devices:{described.__name__}Sensor",
        f"robolink.interfaces.{message}",
        f"robolink.world_node.messages:{convert}",
    )


_KINDS = {
    "lidar": _kind(Lidar, "sensor_msgs.msg:LaserScan", "scan_message"),
    "bumper": _kind(Bumper, "std_msgs.msg:Bool", "bumper_message"),
    "imu": _kind(Imu, "sensor_msgs.msg:Imu", "imu_message"),
    "range_finder": _kind(RangeFinder, "sensor_msgs.msg:Range", "range_message"),
    "encoders": _kind(Encoders, "sensor_msgs.msg:JointState", "joint_state_message"),
    "camera": _kind(Camera, "sensor_msgs.msg:Image", "image_message"),
}


def _kind_at(entry: EntryPoint) -> SensorKind:
    found = entry.load()
    if not isinstance(found, SensorKind):
        raise RobolinkError(f"a sensor is a robolink.sim.sensors.SensorKind, not a {type(found).__name__}")
    if found.description.__struct_fields__[0] != entry.name:  # the first key names the kind: no other finds it
        raise RobolinkError(f"the first field of {found.description.__name__} must be '{entry.name}'")
    return found


SENSORS = Registry("robolink.sensors", lambda: _KINDS, _kind_at)
"""Registry of the kinds of sensors, by the key that names them in a world file."""


def kind_of(sensor: Sensor) -> SensorKind:
    """Return the kind of a sensor."""
    found = SENSORS.get(sensor.kind)
    assert found is not None, f"no kind of sensor has the key {sensor.kind}"
    return found
