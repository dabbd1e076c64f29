"""Exceptions of robolink, the common ones: one root, each also a subclass of the stdlib class one would catch.

RobolinkError
├─ DocumentError (ValueError)                    a YAML file or text that is not what it should be
├─ MessageError (ValueError)                     a message type or value
│   ├─ DefinitionError                           the text of a .msg, .srv or .action file
│   ├─ EncodeError (TypeError)                   a field that does not fit its type
│   │   └─ OutOfRangeError (OverflowError)       a number that its type cannot hold
│   └─ DecodeError                               bytes that are not a message of this type
├─ WireError (ValueError)                        a key, token or attachment that is not rmw_zenoh's
├─ TransportError (ConnectionError)              the network below
│   ├─ TransportClosedError                      used after close
│   ├─ SecurityError (PermissionError)           what keys or rights do not allow
│   ├─ OverwrittenError                          a message in shared memory that its sender has overwritten
│   └─ SessionReplacedError                      a call whose session was replaced meanwhile
├─ NotFoundError (LookupError)                   a node, config, type or topic that is not there
│   └─ AmbiguousNameError                        several that a short name may mean
│
│  rclpy's own, by their own names:
├─ NotInitializedException (RuntimeError)        no context, or one that is shut down
├─ NoTypeSupportImportedException (TypeError)    a class that is not a message type
├─ InvalidHandle (RuntimeError)                  an entity that was destroyed
├─ RCLError (RuntimeError)                       what rclpy's C extension raises
│   └─ NodeNameNonExistentError (LookupError)    a node that the graph does not have
├─ NameValidationException (ValueError)          a name with a character or a form that ROS does not allow
│   └─ InvalidNamespaceException, InvalidNodeNameException, InvalidTopicNameException, InvalidServiceNameException
├─ ParameterException                            a parameter of a node
│   ├─ ParameterNotDeclaredException (LookupError)
│   ├─ ParameterAlreadyDeclaredException
│   ├─ InvalidParameterException (ValueError)
│   ├─ InvalidParameterTypeException (TypeError)
│   ├─ InvalidParameterValueException (ValueError)
│   ├─ ParameterImmutableException
│   └─ ParameterUninitializedException (ValueError)
├─ TimeSourceChangedError                        a clock that began or ceased to follow /clock during a sleep
├─ BlockingCallError (RuntimeError)              a call that would block the event loop of an AsyncNode
├─ ServiceError (RuntimeError)                   a call without an answer: no server, or one that went away
└─ ExternalShutdownException                     the context was shut down while somebody spins
    ├─ InterruptedByUser (KeyboardInterrupt)     by Ctrl-C
    └─ ROSInterruptException
"""

from __future__ import annotations

import itertools
import sys
from collections.abc import Iterable

LONGEST_NAME, MOST_NAMES = 255, 2000
"""Longest name, in letters, and most names that are compared for one that may have been meant: that takes time."""


class RobolinkError(Exception):
    """Root of all exceptions of robolink."""


class DocumentError(RobolinkError, ValueError):
    """A YAML document is malformed or says what it cannot say; the text begins with file:line:column.

    `message` is what stands behind that. `line` and `column` count from 1; 0 is for none, and `file` '' for no file.
    """

    def __init__(self, message: str, file: str = "", line: int = 0, column: int = 0) -> None:
        self.message, self.file, self.line, self.column = message, file, line, column
        place = file + "".join(f":{number}" for number in (line, column) if number)
        super().__init__(f"{place}: {message}" if place else message)


class MessageError(RobolinkError, ValueError):
    """A message type or a message's value is not what it should be."""


class DefinitionError(MessageError):
    """The text of a .msg, .srv or .action file is not what it should be; it begins with file:line:column."""


class EncodeError(MessageError, TypeError):
    """A field's value does not fit its type; the text names the field."""


class OutOfRangeError(EncodeError, OverflowError):
    """A number does not fit the type of its field; as rclpy's, it is an OverflowError."""


class DecodeError(MessageError):
    """Bytes that are not a message of the type at hand."""


class WireError(RobolinkError, ValueError):
    """A key, token or attachment that does not follow rmw_zenoh."""


class TransportError(RobolinkError, ConnectionError):
    """The network below failed; the text says which address or key."""


class TransportClosedError(TransportError):
    """A transport was used after it had been closed."""


class SecurityError(TransportError, PermissionError):
    """Keys, certificates or rights do not allow it; the text names the enclave, the request, and the rule."""


class OverwrittenError(TransportError):
    """A message that came through shared memory was overwritten by its sender before it was read.

    Args:
        attachment: Attachment of the message, which is intact; b"" if unknown.
    """

    def __init__(self, attachment: bytes = b"") -> None:
        self.attachment = attachment
        super().__init__("its sender had overwritten it in shared memory before it was read: this process stood still")


class SessionReplacedError(TransportError):
    """A call was under way when its session was replaced by another one: its answer cannot come any more."""

    def __init__(self) -> None:
        super().__init__(
            "this machine's address or keys changed while the call was under way: its answer is lost, though the server"
            " may have done it; call again if that does no harm"
        )


class NotFoundError(RobolinkError, LookupError):
    """Something was requested by name and is not there; the text names what is near.

    Args:
        kind: Word for what it is, such as "node".
        name: Name that was requested.
        known: Names that there are.
        where: Place that was searched; '' names none.
    """

    def __init__(self, kind: str, name: str, known: Iterable[str] = (), where: str = "") -> None:
        self.kind, self.name = kind, name
        place = f" in {where}" if where else ""
        super().__init__(f"no {kind} named '{name}'{place}{nearest(name, known)}")


class AmbiguousNameError(NotFoundError):
    """Something was asked for by a short name that several have: `kind` and `name` of it, and the names `meant`."""

    def __init__(self, kind: str, name: str, meant: Iterable[str]) -> None:
        self.kind, self.name = kind, name
        RobolinkError.__init__(self, f"which {kind} '{name}'? There are {', '.join(meant)}: give a whole name")


def nearest(name: str, known: Iterable[str]) -> str:
    """Return `` (did you mean 'x'?)`` for that of the `known` names which is closest to `name`, or nothing.

    >>> nearest("wandr", ["wander", "follow"])
    " (did you mean 'wander'?)"

    One that only lacks an ending, as of a file, is the closest of all:

    >>> nearest("talker", ["walker", "talker.py"])
    " (did you mean 'talker.py'?)"
    """
    close = closest(name, known)
    return f" (did you mean '{close}'?)" if close else ""


def closest(name: str, known: Iterable[str], alike: float = 0.6) -> str:
    """Return that of the `known` names closest to `name`, or one that differs in capitals alone; '' if none is close.

    `alike` is how much two names must agree, by difflib's ratio: 1 is the same.
    """
    import difflib  # late: every command imports this module, few need it

    if len(name) > LONGEST_NAME:
        return ""
    names = list(itertools.islice((each for each in known if len(each) <= LONGEST_NAME), MOST_NAMES))
    found = [each for each in names if name and each.startswith(f"{name}.")]
    found = found or difflib.get_close_matches(name, names, n=1, cutoff=alike)
    return (found or [each for each in names if each.lower() == name.lower()] or [""])[0]


def imported_as() -> str:
    """Return the name by which the program knows robolink: errors speak of `rclpy` to whoever wrote that."""
    return "rclpy" if sys.modules.get("rclpy", "") is sys.modules["robolink"] else "robolink"


SIGNAL = "a signal (Ctrl-C or SIGTERM)"
"""Cause of a context's end by a signal."""


class NotInitializedException(RobolinkError, RuntimeError):
    """robolink was used before `init()`, or after its context's end by what `ended_by` names; for `message`."""

    def __init__(self, message: str | None = None, *, ended_by: str = "") -> None:
        self.by_signal = ended_by == SIGNAL
        """True if a signal ended the context: the program was on its way to spin when it came."""
        why = f"{ended_by} has ended the context" if ended_by else f"{imported_as()}.init() has not been called"
        super().__init__(why + (f": {message}" if message else ""))


class NoTypeSupportImportedException(RobolinkError, TypeError):
    """A class that is not a message class was given where one is needed."""


class RCLError(RobolinkError, RuntimeError):
    """ROS 2's client library refused something: what rclpy's C library raises under this name."""


class InvalidHandle(RobolinkError, RuntimeError):
    """An entity was used after it had been destroyed."""


class NodeNameNonExistentError(RCLError, LookupError):
    """A node was asked about that is not there."""


class NameValidationException(RobolinkError, ValueError):
    """A name of a node, topic, service or namespace breaks ROS 2's rules.

    Args:
        name_type: Word for what is named, such as "topic name".
        name: Name that is invalid.
        error_msg: Rule that it breaks.
        invalid_index: Index of the bad character.
    """

    def __init__(self, name_type: str, name: str, error_msg: str, invalid_index: int) -> None:
        self.name_type, self.name, self.error_msg, self.invalid_index = (
            name_type,
            name,
            error_msg,
            invalid_index,
        )
        shown = name if len(name) <= 200 else name[:200] + "…"
        caret = " " * min(invalid_index, 200) + "^"
        super().__init__(f"Invalid {name_type}: {error_msg}:\n  '{shown}'\n   {caret} is invalid")


class InvalidNamespaceException(NameValidationException):
    """A namespace, `name`, breaks the rule `error_msg` at `invalid_index`."""

    def __init__(self, name: str, error_msg: str, invalid_index: int) -> None:
        super().__init__("namespace", name, error_msg, invalid_index)


class InvalidNodeNameException(NameValidationException):
    """The `name` of a node breaks the rule `error_msg` at `invalid_index`."""

    def __init__(self, name: str, error_msg: str, invalid_index: int) -> None:
        super().__init__("node name", name, error_msg, invalid_index)


class InvalidTopicNameException(NameValidationException):
    """The `name` of a topic breaks the rule `error_msg` at `invalid_index`."""

    def __init__(self, name: str, error_msg: str, invalid_index: int) -> None:
        super().__init__("topic name", name, error_msg, invalid_index)


class InvalidServiceNameException(NameValidationException):
    """The `name` of a service breaks the rule `error_msg` at `invalid_index`."""

    def __init__(self, name: str, error_msg: str, invalid_index: int) -> None:
        super().__init__("service name", name, error_msg, invalid_index)


class ParameterException(RobolinkError):
    """Root of the exceptions about parameters: `error_msg`, the names of the `parameters`, and further `args`."""

    def __init__(self, error_msg: str, parameters: str | Iterable[str], *args: object) -> None:
        self.parameters = parameters
        super().__init__(f"{error_msg}: {parameters}", *args)


class ParameterNotDeclaredException(ParameterException, LookupError):
    """One of `parameters` was used before it was declared; of those `known`, the text names the nearest.

    Further `args` are Exception's.
    """

    def __init__(self, parameters: str | Iterable[str], *args: object, known: Iterable[str] = ()) -> None:
        names = [parameters] if isinstance(parameters, str) else list(parameters)
        shown = ", ".join(name + nearest(name, known) for name in names)
        super().__init__("Parameter not declared", shown, *args)
        self.parameters = parameters if isinstance(parameters, str) else names


class ParameterAlreadyDeclaredException(ParameterException):
    """The `parameters` were declared twice; further `args` are Exception's."""

    def __init__(self, parameters: str | Iterable[str], *args: object) -> None:
        super().__init__("Parameter(s) already declared", parameters, *args)


class InvalidParameterException(ParameterException, ValueError):
    """A `parameter_name` breaks ROS 2's rules."""

    def __init__(self, parameter_name: str) -> None:
        super().__init__("Invalid parameter name", parameter_name)


class InvalidParameterTypeException(ParameterException, TypeError):
    """A parameter was given a value of another type than it was declared with.

    Args:
        desired_parameter: Parameter that was to be set, or its name.
        expected_type: Name of the type that it was declared with.
        *args: Further arguments of Exception.
    """

    def __init__(self, desired_parameter: object, expected_type: str, *args: object) -> None:
        name = getattr(desired_parameter, "name", str(desired_parameter))
        value = getattr(desired_parameter, "value", None)
        found = getattr(getattr(desired_parameter, "type_", None), "name", type(value).__name__)
        RobolinkError.__init__(
            self,
            f"Trying to set parameter '{name}' to '{value}' of type '{found}', "
            f"expecting type '{expected_type}'{_cure(found, expected_type, value)}",
            *args,
        )
        self.param_name, self.parameters = name, name


def _cure(found: str, expected: str, value: object) -> str:
    """Return how to write what was probably meant: YAML makes an integer of `1`, and of `0x10` too."""
    if (found, expected) == ("INTEGER", "DOUBLE"):
        return f": write {value}.0"
    if expected == "STRING" and "ARRAY" not in found:
        return ": text that is also a number, true or false needs quotes, two pairs in a shell: \"'...'\""
    return ""


class InvalidParameterValueException(ParameterException, ValueError):
    """A value was refused by the range of its `parameter`, or by a callback.

    Args:
        parameter: Name of the parameter.
        value: Value that was refused.
        reason: Reason in words; '' for none.
        *args: Further arguments of Exception.
    """

    def __init__(self, parameter: str, value: object, reason: str, *args: object) -> None:
        message = f"Invalid parameter value ({value}) for parameter"
        super().__init__(f"{message}. Reason: {reason}" if reason else message, parameter, *args)


class ParameterImmutableException(ParameterException):
    """A read-only parameter, `parameter_name`, was set."""

    def __init__(self, parameter_name: str) -> None:
        super().__init__("Attempted to modify read-only parameter", parameter_name)


class ParameterUninitializedException(ParameterException, ValueError):
    """A statically typed parameter, `parameter_name`, was read before it had a value."""

    def __init__(self, parameter_name: str) -> None:
        super().__init__("The parameter is not initialized", parameter_name)


class ExternalShutdownException(RobolinkError):
    """The context was shut down by something other than the program's own flow."""


class InterruptedByUser(KeyboardInterrupt, ExternalShutdownException):
    """`spin` was ended by Ctrl-C: programs for Humble catch the first parent, programs for Jazzy the second.

    Anywhere else Ctrl-C is a KeyboardInterrupt alone, which `except Exception` lets pass. `text` is that of the error.
    """

    def __init__(self, text: str = "interrupted") -> None:
        super().__init__(text)


class TimeSourceChangedError(RobolinkError):
    """A clock began or ceased to follow /clock while somebody slept by it, so that the end of the sleep is unknown."""


class ROSInterruptException(ExternalShutdownException):
    """A rate's sleep was ended because its context shut down: no fault of the callback that sleeps."""


class BlockingCallError(RobolinkError, RuntimeError):
    """A call would block the event loop of an AsyncNode, and so what it waits for. `text` is that of the error."""

    def __init__(
        self,
        text: str = (
            "this call would wait in the thread of the event loop, which could do nothing else meanwhile: await the"
            " asynchronous one instead (send_goal_async, cancel_goal_async, get_result_async, lookup_transform_async)"
        ),
    ) -> None:
        super().__init__(text)


class ServiceError(RobolinkError, RuntimeError):
    """A service call got no answer: nobody serves it, or the server went away."""
