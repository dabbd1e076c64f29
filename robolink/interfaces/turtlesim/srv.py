"""The services of turtlesim: turtles come, go, jump and draw."""

from robolink.message import Message, Service, float32, string, uint8


class Spawn(Service):
    """Make a new turtle."""

    class Request(Message):
        """Where, in metres and radians, and its name; an empty name lets the simulator choose one."""

        x: float32
        y: float32
        theta: float32
        name: string

    class Response(Message):
        """The turtle's name."""

        name: string


class Kill(Service):
    """Take a turtle away."""

    class Request(Message):
        """The turtle's name."""

        name: string

    class Response(Message):
        """Nothing."""


class SetPen(Service):
    """Change the line that a turtle draws."""

    class Request(Message):
        """Colour from 0 to 255, width in pixels; a turtle with `off` above 0 draws nothing."""

        r: uint8
        g: uint8
        b: uint8
        width: uint8
        off: uint8

    class Response(Message):
        """Nothing."""


class TeleportAbsolute(Service):
    """Put a turtle elsewhere."""

    class Request(Message):
        """Where, in metres and radians."""

        x: float32
        y: float32
        theta: float32

    class Response(Message):
        """Nothing."""


class TeleportRelative(Service):
    """Move a turtle at once."""

    class Request(Message):
        """First it turns by `angular` radians, then it goes `linear` metres ahead."""

        linear: float32
        angular: float32

    class Response(Message):
        """Nothing."""
