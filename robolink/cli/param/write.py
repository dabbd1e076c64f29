"""Writing verbs of `robolink param`: set, load and delete."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

from robolink.arguments.parameter_file import ParameterFileError, read_parameter_file
from robolink.cli.param.ask import ParameterClient, asking
from robolink.cli.param.values import fitting, plain, read, type_name
from robolink.cli.shared import messages
from robolink.cli.shared.output import complain, say, tell
from robolink.exceptions import NotFoundError
from robolink.interfaces.rcl_interfaces.msg import (
    Parameter,
    ParameterDescriptor,
    ParameterValue,
    SetParametersResult,
)
from robolink.parameter import get_parameter_value

if TYPE_CHECKING:
    from robolink.arguments.overrides import Override, Value

UNCHANGED = "it is read-only and has this value already"


def set_one(node: str, parameter: str, text: str, timeout: float, *, as_json: bool) -> int:
    """Set a parameter, and return the exit code. The text is read as the type that the parameter has."""
    with asking(node, timeout) as client:
        value = read(text, _descriptor(client, parameter))
        result = client.set([Parameter(name=parameter, value=value)])[0]
        if result.successful:
            _tell_of_type(parameter, text, get_parameter_value(text).type, value)
    return _tell(result, as_json, "Set parameter successful", "Setting parameter failed")


def _tell_of_type(name: str, written: object, type_: int, value: ParameterValue) -> None:
    """Print that ros2 refuses the value that was converted here: it sends a value of the type that the text has."""
    if type_ != value.type:
        fitting_type, other = type_name(value.type), type_name(type_)
        tell(f"note: {name} is of type {fitting_type}; ros2 takes {written} for one of type {other} and refuses it")


def delete(node: str, parameter: str, timeout: float, *, as_json: bool) -> int:
    """Undeclare a parameter, and return the exit code."""
    with asking(node, timeout) as client:
        result = client.set([Parameter(name=parameter, value=ParameterValue())])[0]
    return _tell(result, as_json, "Deleted parameter successfully", "Deleting parameter failed")


def load(node: str, file: str, timeout: float, *, use_wildcard: bool, as_json: bool) -> int:
    """Set the parameters that a file has for a node, and return the exit code: 1 if any was refused.

    Raises ParameterFileError, and what `asking` raises.
    """
    overrides = read_parameter_file(file)
    with asking(node, timeout) as client:
        values = meant_for(client.name, overrides, file, use_wildcard=use_wildcard)
        results = _load(client, values)
    if as_json:
        say(messages.as_json({name: _plain(result) for name, result in results.items()}))
        return int(not all(each.successful for each in results.values()))
    codes = [
        _tell(each, False, f"Set parameter {name} successful", f"Set parameter {name} failed")
        for name, each in results.items()
    ]
    return max(codes, default=0)


def meant_for(node: str, overrides: Sequence[Override], file: str, *, use_wildcard: bool) -> dict[str, Value]:
    """Return the parameters in a file for a node: of its own section, and of those with * in their names if wanted.

    If there is no section for it, but one for a single other node, that is taken: a file that was dumped of one
    node is loaded into another. Raises ParameterFileError if there is nothing.
    """
    own = list(dict.fromkeys(each.pattern for each in overrides if "*" not in each.pattern))
    section = own[0] if node not in own and len(own) == 1 else node
    wild = [each for each in overrides if use_wildcard and "*" in each.pattern and each.is_for(node)]
    found = [*wild, *(each for each in overrides if each.pattern == section)]
    if not found:
        has = f": it has {', '.join(own)}" if own else ""
        raise ParameterFileError(f"{file}: no parameters for {node}{has}")
    return {each.name: each.value for each in found}


def _load(client: ParameterClient, values: dict[str, Any]) -> dict[str, SetParametersResult]:
    known = set(client.names())
    names = [each for each in values if each in known]
    descriptors = dict(zip(names, client.descriptors(names), strict=True)) if names else {}
    wanted = {name: fitting(value, descriptors.get(name)) for name, value in values.items()}
    results = dict.fromkeys(values, SetParametersResult(successful=True, reason=UNCHANGED))
    to_set = [name for name in values if name not in _unchanged(client, wanted, descriptors)]
    given = client.set([Parameter(name=name, value=wanted[name]) for name in to_set]) if to_set else []
    results.update(zip(to_set, given, strict=True))
    for name in to_set:
        if results[name].successful:
            _tell_of_type(name, values[name], fitting(values[name], None).type, wanted[name])
    return results


def _unchanged(
    client: ParameterClient, wanted: dict[str, ParameterValue], descriptors: dict[str, ParameterDescriptor]
) -> Iterable[str]:
    """Return the read-only parameters that have the wanted value already: a file that was dumped has those too."""
    fixed = [name for name, each in descriptors.items() if each.read_only]
    now = client.settled_values(fixed) if fixed else {}
    return {name for name, each in now.items() if (each.type, plain(each)) == (wanted[name].type, plain(wanted[name]))}


def _descriptor(client: ParameterClient, parameter: str) -> ParameterDescriptor | None:
    try:
        return client.descriptors([parameter])[0]
    except NotFoundError:  # the node says so itself, or allows it
        return None


def _tell(result: SetParametersResult, as_json: bool, done: str, failed: str) -> int:
    if as_json:
        say(messages.as_json(_plain(result)))
        return int(not result.successful)
    text = f"{done if result.successful else failed}{': ' if result.reason else ''}{result.reason}"
    if not result.successful:
        return complain(text)
    say(text)
    return 0


def _plain(result: SetParametersResult) -> dict[str, Any]:
    return {"successful": result.successful, "reason": result.reason}
