"""The services of diagnostic_msgs: self-tests, and more to watch over."""

from robolink.interfaces.diagnostic_msgs.msg import DiagnosticStatus
from robolink.message import Message, Sequence, Service, byte, string


class SelfTest(Service):
    """Run the self-test of a device."""

    class Request(Message):
        """Nothing."""

    class Response(Message):
        """Outcome: `passed` is the byte 1 when all tests passed, the byte 0 when one failed.

        `id` names the device that was tested; `status` has one entry for each test.
        """

        id: string
        passed: byte
        status: Sequence[DiagnosticStatus]


class AddDiagnostics(Service):
    """Add parts for the diagnostic aggregator to watch, while it runs."""

    class Request(Message):
        """The namespace, given in full (``/my/name/space``), whose parameters say how the parts are to be analysed."""

        load_namespace: string

    class Response(Message):
        """Success, and a sentence for people. A namespace that is watched already is refused."""

        success: bool
        message: string
