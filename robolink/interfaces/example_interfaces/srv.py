"""The services of example_interfaces: adding, switching and setting off."""

from robolink.message import Message, Service, int64, string


class AddTwoInts(Service):
    """Add two numbers."""

    class Request(Message):
        """The numbers."""

        a: int64
        b: int64

    class Response(Message):
        """Their sum."""

        sum: int64


class SetBool(Service):
    """Switch something on or off."""

    class Request(Message):
        """On is True."""

        data: bool

    class Response(Message):
        """Success, and a sentence for people, above all after a failure."""

        success: bool
        message: string


class Trigger(Service):
    """Set something off."""

    class Request(Message):
        """Nothing."""

    class Response(Message):
        """Success, and a sentence for people, above all after a failure."""

        success: bool
        message: string
