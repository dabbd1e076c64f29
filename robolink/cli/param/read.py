"""Reading verbs of `robolink param`: list, get, describe and dump."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import typer

from robolink.cli.param.ask import ParameterClient, asking, serves
from robolink.cli.param.values import Type, as_file, in_json, label, plain, type_name
from robolink.cli.shared import messages
from robolink.cli.shared.graph import is_hidden
from robolink.cli.shared.output import say, tell
from robolink.cli.shared.session import looking, node_of
from robolink.exceptions import RobolinkError
from robolink.parameter import parameter_value_to_python
from robolink.system.terminal import fit

if TYPE_CHECKING:
    from robolink.interfaces.rcl_interfaces.msg import ParameterDescriptor


class Wanted(NamedTuple):
    """Options of `param list`: which parameters of which nodes, and if with their types."""

    prefixes: tuple[str, ...] = ()
    pattern: re.Pattern[str] | None = None
    types: bool = False
    hidden_nodes: bool = False


Found = dict[str, str]
"""Names of parameters, each with its type, which is empty unless it is wanted."""


def compiled(pattern: str) -> re.Pattern[str] | None:
    """Compile the regular expression of `--filter`; end with a usage error if it is none."""
    try:
        return re.compile(pattern) if pattern else None
    except re.error as error:
        raise typer.BadParameter(f"--filter: no regular expression: {error}") from None


def show_list(node: str, wanted: Wanted, *, as_json: bool) -> None:
    """List the parameters of one node, or of all that serve them."""
    if node:
        with asking(node, 0.0) as client:
            found = {client.name: _listed(client, wanted)}
    else:
        found = _of_all(wanted)
    if as_json:
        say(messages.as_json({name: each if wanted.types else list(each) for name, each in found.items()}))
        return
    for name, parameters in found.items():
        if not node and parameters:
            say(f"{name}:")
        for each, type_ in parameters.items():
            line = f"  {each} (type: {type_})" if wanted.types else f"  {each}"
            say(fit(line, lines=False))


def _of_all(wanted: Wanted) -> dict[str, Found]:
    """Return the parameters of all nodes, asked at once. Those that do not answer are noted on standard error."""
    from concurrent.futures import ThreadPoolExecutor

    with looking() as context:
        names = sorted({each.full_node_name for each in context.graph.nodes()})
        names = [name for name in names if serves(context, name) and (wanted.hidden_nodes or not is_hidden(name))]
        asker = node_of(context)
        with ThreadPoolExecutor(max_workers=max(1, min(32, len(names)))) as pool:
            futures = {name: pool.submit(_listed, ParameterClient(asker, name), wanted) for name in names}
        found = {}
        for name, future in futures.items():
            try:
                found[name] = future.result()
            except RobolinkError as error:
                tell(f"robolink: {name}: {error}")
    return found


def _listed(client: ParameterClient, wanted: Wanted) -> Found:
    names = [each for each in client.names(wanted.prefixes) if wanted.pattern is None or wanted.pattern.match(each)]
    if not wanted.types or not names:
        return dict.fromkeys(names, "")
    descriptors = client.descriptors(names)
    return {name: type_name(each.type) for name, each in zip(names, descriptors, strict=True)}


def show_value(node: str, parameter: str, timeout: float, *, hide_type: bool, as_json: bool) -> None:
    """Show one value. Raises NotFoundError if there is no such parameter."""
    with asking(node, timeout) as client:
        value = client.values([parameter])[0]
    if as_json:
        say(messages.as_json({"name": parameter, "type": type_name(value.type), "value": plain(value)}))
    elif value.type == Type.NOT_SET:
        say("Parameter not set.")
    else:
        text = str(parameter_value_to_python(value))
        say(text if hide_type else f"{label(value.type)} {text}")


def show_descriptors(node: str, parameters: Sequence[str], timeout: float, *, as_json: bool) -> None:
    """Show the descriptors of parameters. Raises NotFoundError for one that the node lacks."""
    with asking(node, timeout) as client:
        descriptors = client.descriptors(parameters)
    if as_json:
        say(messages.as_json([_described(each) for each in descriptors]))
        return
    for each in descriptors:
        say("\n".join(_lines(each)))


def _described(descriptor: ParameterDescriptor) -> dict[str, Any]:
    """Return a descriptor as data, with ros2's name of the type, and its range, of whichever kind."""
    found = messages.plain(descriptor)
    limits = found.pop("floating_point_range") + found.pop("integer_range")
    return {**found, "type": type_name(descriptor.type), "range": limits[0] if limits else None}


def _lines(descriptor: ParameterDescriptor) -> list[str]:
    lines = [f"Parameter name: {fit(descriptor.name, lines=False)}", f"  Type: {type_name(descriptor.type)}"]
    if descriptor.description:
        lines.append(f"  Description: {descriptor.description}")
    lines.append("  Constraints:")
    if descriptor.read_only:
        lines.append("    Read only: true")
    ranges: list[Any] = [*descriptor.floating_point_range, *descriptor.integer_range]
    for limits in ranges[:1]:
        lines += [f"    Min value: {limits.from_value}", f"    Max value: {limits.to_value}"]
        lines += [f"    Step: {limits.step}"] if limits.step else []
    if descriptor.additional_constraints:
        lines.append(f"    Additional constraints: {descriptor.additional_constraints}")
    return lines


def dump(node: str, timeout: float, *, as_json: bool) -> None:
    """Write the values of all parameters that have one. A parameter file cannot hold arrays of bytes."""
    with asking(node, timeout) as client:
        names = client.names()
        values = client.settled_values(names) if names else {}
    values = {name: each for name, each in values.items() if each.type != Type.NOT_SET}
    if as_json:
        say(messages.as_json(in_json(values.items())))
        return
    for name in [name for name, each in values.items() if each.type == Type.BYTE_ARRAY]:
        tell(f"robolink: left out '{name}': a parameter file cannot hold a byte array")
        del values[name]
    say(as_file(client.name, in_json(values.items())))
