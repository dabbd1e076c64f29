"""The services of std_srvs: do it, switch it, and report whether that worked."""

from robolink.message import Message, Service, string


class Empty(Service):
    """A call that carries nothing but the fact that it happened."""

    class Request(Message):
        """Nothing."""

    class Response(Message):
        """Nothing."""


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
