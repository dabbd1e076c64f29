# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message
import robolink.interfaces.diagnostic_msgs.msg

__all__ = ["AddDiagnostics", "SelfTest"]

class AddDiagnostics(robolink.message.Service):
    """Add parts for the diagnostic aggregator to watch, while it runs.

    The namespace, given in full (``/my/name/space``), whose parameters say how the parts are to be analysed.
    """
    class Request(robolink.message.Message):
        load_namespace: builtins.str
        def __init__(self, *, load_namespace: builtins.str = ...) -> None: ...
    class Response(robolink.message.Message):
        """Success, and a sentence for people. A namespace that is watched already is refused."""
        success: builtins.bool
        message: builtins.str
        def __init__(self, *, success: builtins.bool = ..., message: builtins.str = ...) -> None: ...
class SelfTest(robolink.message.Service):
    """Run the self-test of a device.

    Nothing.
    """
    class Request(robolink.message.Message):
        def __init__(self) -> None: ...
    class Response(robolink.message.Message):
        """Outcome: `passed` is the byte 1 when all tests passed, the byte 0 when one failed.

        `id` names the device that was tested; `status` has one entry for each test.
        """
        id: builtins.str
        passed: builtins.bytes
        status: collections.abc.MutableSequence[robolink.interfaces.diagnostic_msgs.msg.DiagnosticStatus]
        def __init__(self, *, id: builtins.str = ..., passed: builtins.bytes = ..., status: collections.abc.Iterable[robolink.interfaces.diagnostic_msgs.msg.DiagnosticStatus] = ...) -> None: ...
