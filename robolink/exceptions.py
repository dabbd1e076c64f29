"""Every error that robolink raises: one root, each also a subclass of the stdlib class one would catch.

RobolinkError
├─ DocumentError (ValueError)            a YAML file or text that is not what it should be
├─ MessageError (ValueError)             a message type or value
│   ├─ DefinitionError                   the text of a .msg, .srv or .action file
│   ├─ EncodeError (TypeError)           a field that does not fit its type
│   └─ DecodeError                       bytes that are no message of this type
├─ WireError (ValueError)                a key, token or attachment that is not rmw_zenoh's
├─ TransportError (ConnectionError)      the network below
│   └─ TransportClosedError              used after close
├─ NotFoundError (LookupError)           a node, config, type or topic that is not there
│   └─ AmbiguousNameError                several that a short name may mean
└─ rclpy's own, by their own names
"""

from __future__ import annotations

import itertools
import sys
from collections.abc import Iterable

from robolink.terminal import shown as shown  # what errors quote of others' text

LONGEST_NAME, MOST_NAMES = 255, 2000
"""How much is looked through for a name that may have been meant: each comparison takes time."""
MOST_TOLD, MOST_MISTAKES = 20, 100
"""How many of a file's mistakes are told, and how many are looked for."""


class RobolinkError(Exception):
    """The root of all errors of robolink."""


class DocumentError(RobolinkError, ValueError):
    """A YAML document is malformed or says what it cannot say; the text begins with file:line:column.

    `message` is what stands behind that. Lines and columns count from 1; 0 is for what has none, '' for no file.
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


class DecodeError(MessageError):
    """Bytes that are not a message of the type at hand."""


class WireError(RobolinkError, ValueError):
    """A key, token or attachment that does not follow rmw_zenoh."""


class TransportError(RobolinkError, ConnectionError):
    """The network below failed; the text says which address or key."""


class TransportClosedError(TransportError):
    """A transport was used after it had been closed."""


class NotFoundError(RobolinkError, LookupError):
    """Something was asked for by name and is not there; the text names what is near."""

    def __init__(self, kind: str, name: str, known: Iterable[str] = (), where: str = "") -> None:
        self.kind, self.name = kind, name
        place = f" in {where}" if where else ""
        super().__init__(f"no {kind} named '{name}'{place}{nearest(name, known)}")


class AmbiguousNameError(NotFoundError):
    """Something was asked for by a short name that several have; the text gives their whole names."""

    def __init__(self, kind: str, name: str, meant: Iterable[str]) -> None:
        self.kind, self.name = kind, name
        RobolinkError.__init__(self, f"which {kind} '{name}'? There are {', '.join(meant)}: give a whole name")


def nearest(name: str, known: Iterable[str]) -> str:
    """Return `` (did you mean 'x'?)`` for the known name closest to `name`, or nothing.

    >>> nearest("wandr", ["wander", "follow"])
    " (did you mean 'wander'?)"

    One that only lacks an ending, as of a file, is the closest of all:

    >>> nearest("talker", ["walker", "talker.py"])
    " (did you mean 'talker.py'?)"
    """
    close = closest(name, known)
    return f" (did you mean '{close}'?)" if close else ""


def closest(name: str, known: Iterable[str], alike: float = 0.6) -> str:
    """Return the known name closest to `name`, or one that differs in capitals alone; '' if none is close.

    `alike` is how much two names must agree, by difflib's ratio: 1 is the same.
    """
    import difflib  # late: every command imports this module, few need it

    if len(name) > LONGEST_NAME:
        return ""
    names = list(itertools.islice((each for each in known if len(each) <= LONGEST_NAME), MOST_NAMES))
    found = [each for each in names if name and each.startswith(f"{name}.")]
    found = found or difflib.get_close_matches(name, names, n=1, cutoff=alike)
    return (found or [each for each in names if each.lower() == name.lower()] or [""])[0]


def few(errors: Iterable[DocumentError], looked_for: int | None = None) -> list[DocumentError]:
    """Return the first errors of a file, and in place of the others one that says how many they are.

    No more than `looked_for` are counted, where finding each takes time.
    """
    found = list(itertools.islice(errors, looked_for))
    if len(found) <= MOST_TOLD + 1:
        return found
    more = f"{len(found) - MOST_TOLD:,}" if looked_for is None or len(found) < looked_for else "many"
    return [*found[:MOST_TOLD], DocumentError(f"and {more} more mistakes", found[MOST_TOLD].file)]


def imported_as() -> str:
    """Return the name by which the program knows robolink: errors speak of `rclpy` to whoever wrote that."""
    return "rclpy" if sys.modules.get("rclpy", "") is sys.modules["robolink"] else "robolink"


class NotInitializedException(RobolinkError, RuntimeError):
    """robolink was used before `init()`, or after the end of its context by what `ended_by` names."""

    def __init__(self, message: str | None = None, *, ended_by: str = "") -> None:
        why = f"{ended_by} has ended the context" if ended_by else f"{imported_as()}.init() has not been called"
        super().__init__(why + (f": {message}" if message else ""))


class NoTypeSupportImportedException(RobolinkError, TypeError):
    """A class that is no message class was given where one is needed."""


class InvalidHandle(RobolinkError, RuntimeError):
    """An entity was used after it had been destroyed."""


class NodeNameNonExistentError(RobolinkError, RuntimeError, LookupError):
    """A node was asked about that is not there."""


class NameValidationException(RobolinkError, ValueError):
    """A name of a node, topic, service or namespace breaks ROS 2's rules."""

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
    """A namespace breaks ROS 2's rules."""

    def __init__(self, name: str, error_msg: str, invalid_index: int) -> None:
        super().__init__("namespace", name, error_msg, invalid_index)


class InvalidNodeNameException(NameValidationException):
    """A node name breaks ROS 2's rules."""

    def __init__(self, name: str, error_msg: str, invalid_index: int) -> None:
        super().__init__("node name", name, error_msg, invalid_index)


class InvalidTopicNameException(NameValidationException):
    """A topic name breaks ROS 2's rules."""

    def __init__(self, name: str, error_msg: str, invalid_index: int) -> None:
        super().__init__("topic name", name, error_msg, invalid_index)


class InvalidServiceNameException(NameValidationException):
    """A service name breaks ROS 2's rules."""

    def __init__(self, name: str, error_msg: str, invalid_index: int) -> None:
        super().__init__("service name", name, error_msg, invalid_index)


class ParameterException(RobolinkError):
    """The root of the errors about parameters."""

    def __init__(self, error_msg: str, parameters: str | Iterable[str], *args: object) -> None:
        self.parameters = parameters
        super().__init__(f"{error_msg}: {parameters}", *args)


class ParameterNotDeclaredException(ParameterException, LookupError):
    """A parameter was read or set before it was declared; of those `known`, the text names the nearest."""

    def __init__(self, parameters: str | Iterable[str], *args: object, known: Iterable[str] = ()) -> None:
        names = [parameters] if isinstance(parameters, str) else list(parameters)
        shown = ", ".join(name + nearest(name, known) for name in names)
        super().__init__("Parameter not declared", shown, *args)
        self.parameters = parameters if isinstance(parameters, str) else names


class ParameterAlreadyDeclaredException(ParameterException):
    """A parameter was declared twice."""

    def __init__(self, parameters: str | Iterable[str], *args: object) -> None:
        super().__init__("Parameter(s) already declared", parameters, *args)


class InvalidParameterException(ParameterException, ValueError):
    """A parameter's name breaks ROS 2's rules."""

    def __init__(self, parameter_name: str) -> None:
        super().__init__("Invalid parameter name", parameter_name)


class InvalidParameterTypeException(ParameterException, TypeError):
    """A parameter was given a value of another type than it was declared with."""

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
    """Say how to write what was probably meant: YAML makes an integer of `1`, and of `0x10` too."""
    if (found, expected) == ("INTEGER", "DOUBLE"):
        return f": write {value}.0"
    if expected == "STRING" and "ARRAY" not in found:
        return ": text that is also a number, true or false needs quotes, two pairs in a shell: \"'...'\""
    return ""


class InvalidParameterValueException(ParameterException, ValueError):
    """A parameter's value was refused by its range or by a callback."""

    def __init__(self, parameter: str, value: object, reason: str, *args: object) -> None:
        message = f"Invalid parameter value ({value}) for parameter"
        super().__init__(f"{message}. Reason: {reason}" if reason else message, parameter, *args)


class ParameterImmutableException(ParameterException):
    """A read-only parameter was set."""

    def __init__(self, parameter_name: str) -> None:
        super().__init__("Attempted to modify read-only parameter", parameter_name)


class ParameterUninitializedException(ParameterException, ValueError):
    """A statically typed parameter was read before it had a value."""

    def __init__(self, parameter_name: str) -> None:
        super().__init__("The parameter is not initialized", parameter_name)


class ExternalShutdownException(RobolinkError):
    """The context was shut down by something other than the program's own flow."""


class InterruptedByUser(KeyboardInterrupt, ExternalShutdownException):
    """`spin` was ended by Ctrl-C or SIGTERM: programs for Humble catch the first parent, programs for Jazzy the second.

    Anywhere else Ctrl-C is a KeyboardInterrupt alone, which `except Exception` lets pass.
    """

    def __init__(self, text: str = "interrupted") -> None:
        super().__init__(text)


class ROSInterruptException(ExternalShutdownException):
    """A rate's sleep was ended because its context shut down: no fault of the callback that sleeps."""


class ServiceError(RobolinkError, RuntimeError):
    """A service call got no answer: nobody serves it, or the server went away."""
