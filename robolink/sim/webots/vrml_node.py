"""Nodes of a VRML file: their fields by type, and errors with their place in the file."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TypeAlias

from robolink.exceptions import DocumentError
from robolink.system.terminal import shown

Value: TypeAlias = "float | str | bool | Node | None"

LONGEST = 6_000_000
"""Most characters, and bytes, of a world."""

DEEPEST = 60
"""Deepest nesting of nodes, with those that USE brings in."""

MOST = 100_000
"""Most nodes of a world, each counted as often as it is used."""

LARGEST = 1e12
"""Largest absolute value of a number."""

MOST_NOTES = 20
"""Most notes about fields of a world; each kind of mistake is one note, however often it is made."""

_POSE = "translation rotation scale children translationStep rotationStep"

_SOLID = (
    f"{_POSE} name model description contactMaterial immersionProperties boundingObject physics locked"
    " radarCrossSection recognitionColors linearVelocity angularVelocity"
)

_SURFACE = "name appearance contactMaterial translation rotation"

_MOTOR = (
    "name acceleration consumptionFactor controlPID minPosition maxPosition maxVelocity multiplier sound muscles"
    " triggered"
)

_LENS = "fieldOfView width height near far lens motionBlur noise antiAliasing spherical projection"

_JOINT = "jointParameters device endPoint position"

_FIELDS = {
    "WorldInfo": "info title window gravity CFM ERP physics basicTimeStep FPS optimalThreadCount physicsDisableTime"
    " physicsDisableLinearThreshold physicsDisableAngularThreshold defaultDamping inkEvaporation magneticField"
    " coordinateSystem gpsCoordinateSystem gpsReference lineScale randomSeed contactProperties northDirection fast2d"
    " dragForceScale dragTorqueScale",
    "Group": "children",
    "Pose": _POSE,
    "Transform": _POSE,
    "Shape": "appearance geometry castShadows isPickable",
    "Solid": _SOLID,
    "Robot": f"{_SOLID} controller controllerArgs customData supervisor synchronization battery cpuConsumption"
    " selfCollision window remoteControl data showWindow",
    "Physics": "density mass centerOfMass inertiaMatrix damping bounce bounceVelocity coulombFriction"
    " forceDependentSlip orientation",
    "Box": "size",
    "Sphere": "radius subdivision ico",
    "Cylinder": "bottom height radius side top subdivision",
    "Capsule": "bottom height radius side top subdivision",
    "Cone": "bottomRadius height side bottom subdivision",
    "HingeJoint": _JOINT,
    "Hinge2Joint": f"{_JOINT} jointParameters2 device2 position2",
    "SliderJoint": _JOINT,
    "HingeJointParameters": "position axis anchor minStop maxStop springConstant dampingConstant staticFriction"
    " suspensionSpringConstant suspensionDampingConstant suspensionAxis stopERP stopCFM",
    "RotationalMotor": f"{_MOTOR} maxTorque",
    "LinearMotor": f"{_MOTOR} maxForce",
    "PositionSensor": "name noise resolution",
    "Lidar": f"{_SOLID} {_LENS} tiltAngle horizontalResolution verticalFieldOfView numberOfLayers minRange maxRange"
    " type resolution defaultFrequency minFrequency maxFrequency rotatingHead",
    "DistanceSensor": f"{_SOLID} lookupTable type numberOfRays aperture gaussianWidth resolution redColorSensitivity",
    "TouchSensor": f"{_SOLID} type lookupTable resolution",
    "Camera": f"{_SOLID} {_LENS} exposure ambientOcclusionRadius bloomThreshold noiseMaskUrl focus zoom recognition"
    " lensFlare windowPosition pixelSize type colorNoise",
    "RangeFinder": f"{_SOLID} {_LENS} minRange maxRange resolution",
    "PBRAppearance": "baseColor baseColorMap transparency roughness roughnessMap metalness metalnessMap IBLStrength"
    " normalMap normalMapFactor occlusionMap occlusionMapStrength emissiveColor emissiveColorMap emissiveIntensity"
    " textureTransform name",
    "Appearance": "material texture textureTransform name",
    "Material": "ambientIntensity diffuseColor emissiveColor shininess specularColor transparency",
    "Wall": f"{_SURFACE} size",
    "Window": "translation rotation name size windowThickness bottomWallHeight windowHeight frameSize windowSillSize"
    " wallAppearance frameAppearance castShadows",
    "SolidBox": f"{_SURFACE} size enableBoundingObject physics castShadows recognitionColors",
    "WoodenBox": "translation rotation name size mass immersionProperties locked",
    "CardboardBox": "translation rotation name size mass immersionProperties locked",
    "Floor": f"{_SURFACE} size tileSize texture",
    "RectangleArena": "translation rotation name contactMaterial floorSize floorTileSize floorAppearance wallThickness"
    " wallHeight wallAppearance floorTextureUrl wallTextureUrl wallColor wallTileSize",
    "HokuyoUrg04lx": "translation rotation name noise resolution enablePhysics",
    "HokuyoUrg04lxug01": "translation rotation name noise resolution enablePhysics",
    "HokuyoUtm30lx": "translation rotation name noise resolution enablePhysics",
    "RobotisLds01": "translation rotation name noise enablePhysics",
    "SickLms291": "translation rotation name noise resolution enablePhysics",
    "CircleArena": "translation rotation name radius contactMaterial floorAppearance floorTileSize wallThickness"
    " wallHeight wallAppearance subdivision floorTextureUrl wallTextureUrl wallTileSize",
}

KNOWN_FIELDS: dict[str, frozenset[str]] = {kind: frozenset(names.split()) for kind, names in _FIELDS.items()}
"""Field names of each node type that is read here."""


class Notes:
    """Collector of what Webots repairs or ignores with a warning of its own, in the files of one world."""

    def __init__(self) -> None:
        self._found: dict[tuple[str, ...], str] = {}

    def add(self, about: DocumentError, *key: str) -> None:
        """Add a note; a later one with the same `key` is left out."""
        if len(self._found) < MOST_NOTES:
            self._found.setdefault(key, str(about))

    def __iter__(self) -> Iterator[str]:
        return iter(self._found.values())


class Source:
    """The text of a world or PROTO and its name; finds line and column of a place."""

    def __init__(self, text: str, name: str, notes: Notes | None = None) -> None:
        self.text, self.name = text.removeprefix("\ufeff"), name
        self.notes = Notes() if notes is None else notes

    def error(self, offset: int, message: str) -> DocumentError:
        """Make an error, to raise, about the text at `offset`."""
        line = self.text.count("\n", 0, offset) + 1
        column = offset - self.text.rfind("\n", 0, offset)
        return DocumentError(shown(message, 300), self.name, line, column)


class Field:
    """The values of a node's field: one or a list; a vector is its numbers."""

    __slots__ = ("offset", "source", "values")

    def __init__(self, values: Sequence[Value], offset: int, source: Source) -> None:
        self.values, self.offset, self.source = values, offset, source


class Node:
    """A node: its type, its fields, and the name that DEF gave it.

    The readers of fields give `default` where the field is absent, and raise `DocumentError` at the field's place
    where it holds something else than was asked for.
    """

    __slots__ = ("defined", "depth", "fields", "offset", "size", "source", "type")

    def __init__(self, kind: str, fields: dict[str, Field], source: Source, offset: int) -> None:
        self.type, self.fields, self.source, self.offset = kind, fields, source, offset
        self.defined = ""
        inner = [value for field in fields.values() for value in field.values if isinstance(value, Node)]
        self.depth: int = 1 + max((each.depth for each in inner), default=0)
        self.size: int = 1 + sum(each.size for each in inner)
        if self.depth > DEEPEST:
            raise self.error(f"more than {DEEPEST} nodes are inside of each other")
        if self.size > MOST:
            raise self.error(f"this has more than {MOST} nodes")

    @property
    def called(self) -> str:
        """The node for a message: its type and name."""
        field = self.fields.get("name")
        name = field.values[0] if field and field.values else self.defined
        return f"{self.type} '{name}'" if isinstance(name, str) and name else self.type

    def error(self, message: str, field: str = "") -> DocumentError:
        """Make an error (to raise) about this node, or about one of its fields."""
        at = self.fields.get(field)
        prefix = f"{self.type}.{field}: " if field else ""
        source, offset = (at.source, at.offset) if at else (self.source, self.offset)
        return source.error(offset, prefix + message)

    def numbers(self, field: str, *default: float) -> tuple[float, ...]:
        """Return as many numbers as the default has."""
        found = self.all_numbers(field) if field in self.fields else list(default)
        if len(found) != len(default):
            raise self.error(f"expected {_counted(len(default), 'number')}, got {len(found)}", field)
        return tuple(found)

    def number(self, field: str, default: float) -> float:
        """Return a number."""
        return self.numbers(field, default)[0]

    def lengths(self, field: str, *default: float) -> tuple[float, ...]:
        """Return as many numbers as the default has, each more than 0; the default, with a note, in place of others."""
        found = self.numbers(field, *default)
        if min(found) <= 0.0:
            self.note(f"expected more than 0, got {min(found):g}; {_spelled(default)} is used", field)
            return default
        return found

    def note(self, message: str, field: str = "") -> None:
        """Note what Webots warns of: the value of a field that it repairs or ignores."""
        self.source.notes.add(self.error(message, field), self.type, field)

    def truth(self, field: str, default: bool) -> bool:
        """Return a boolean."""
        values = self.fields[field].values if field in self.fields else [default]
        if len(values) != 1 or not isinstance(values[0], bool):
            raise self.error(f"expected TRUE or FALSE, got {_worded(values[0] if values else None)}", field)
        return values[0]

    def length(self, field: str, default: float) -> float:
        """Return a number that is more than 0."""
        return self.lengths(field, default)[0]

    def all_numbers(self, field: str) -> list[float]:
        """Return all the numbers of a field."""
        values = self.fields[field].values if field in self.fields else ()
        for value in values:
            if not isinstance(value, float):
                raise self.error(f"expected numbers, got {_worded(value)}", field)
            if abs(value) > LARGEST:
                raise self.error(f"expected at most {LARGEST:g}, got {value:g}", field)
        return [value for value in values if isinstance(value, float)]

    def text(self, field: str, default: str = "") -> str:
        """Return a string; of several the first."""
        return next(iter(self.texts(field)), default)

    def texts(self, field: str) -> list[str]:
        """Return all the strings of a field."""
        values = self.fields[field].values if field in self.fields else ()
        for value in values:
            if not isinstance(value, str):
                raise self.error(f"expected a string, got {_worded(value)}", field)
        return [value for value in values if isinstance(value, str)]

    def nodes(self, field: str) -> list[Node]:
        """Return the nodes of a field; NULL is none."""
        values = self.fields[field].values if field in self.fields else ()
        for value in values:
            if not isinstance(value, Node) and value is not None:
                raise self.error(f"expected a node, got {_worded(value)}", field)
        return [value for value in values if isinstance(value, Node)]

    def node(self, field: str) -> Node | None:
        """Return the only node of a field, or None."""
        return next(iter(self.nodes(field)), None)


def _worded(value: Value) -> str:
    if isinstance(value, Node):
        return f"a {value.type}"
    if isinstance(value, bool):
        return str(value).upper()
    return "NULL" if value is None else f"'{shown(value, 40)}'" if isinstance(value, str) else f"{value:g}"


def _spelled(numbers: Sequence[float]) -> str:
    return " ".join(f"{each:g}" for each in numbers)


def _counted(count: int, what: str) -> str:
    return f"{count} {what}" if count == 1 else f"{count} {what}s"
