"""The verbs of parameters, over a client of one node's parameter services; and completion of parameter names."""

from __future__ import annotations

import contextlib
import queue
import re
import threading
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar

import typer

from robolink.arguments.parameter_file import ParameterFileError, read_parameter_file
from robolink.cli.param.values import Type, as_file, fitting, in_json, label, plain, read, type_name
from robolink.cli.shared import messages
from robolink.cli.shared.complete import WITHIN, offered
from robolink.cli.shared.graph import absolute, is_hidden, no_such_node
from robolink.cli.shared.output import complain, say, tell
from robolink.cli.shared.session import looking, node_of
from robolink.context import Context
from robolink.exceptions import ExternalShutdownException, NotFoundError, RobolinkError
from robolink.interfaces.rcl_interfaces import srv
from robolink.interfaces.rcl_interfaces.msg import (
    Parameter,
    ParameterDescriptor,
    ParameterValue,
    SetParametersResult,
)
from robolink.parameter import get_parameter_value, parameter_value_to_python
from robolink.system.terminal import fit, shown
from robolink.wire import EndpointKind

if TYPE_CHECKING:
    from robolink.arguments.overrides import Override, Value
    from robolink.node import Node


ANSWER_WITHIN = 5.0
"""Timeout of a node's answer, in seconds: it may be busy with a callback."""


class ParameterCommandError(RobolinkError, RuntimeError):
    """A node's parameters are not available: it does not serve them, or does not answer."""


class ParameterClient:
    """Client of the parameter services of one node."""

    def __init__(self, asker: Node, name: str) -> None:
        self.name = name
        self._asker = asker

    def names(self, prefixes: Sequence[str] = ()) -> list[str]:
        """Return the names of its parameters, sorted; only those below `prefixes`, if there are any."""
        request = srv.ListParameters.Request(prefixes=list(prefixes))
        return sorted(self._call(srv.ListParameters, "list_parameters", request).result.names)

    def values(self, names: Sequence[str]) -> list[ParameterValue]:
        """Return the values. Raises NotFoundError if one is unknown, ParameterCommandError if one has no value."""
        found = list(self._call(srv.GetParameters, "get_parameters", srv.GetParameters.Request(names=names)).values)
        if len(found) == len(names):
            return found
        self._check_known(names)
        raise ParameterCommandError(f"{_listed(names)} of {self.name}: Parameter not set")

    def settled_values(self, names: Sequence[str]) -> dict[str, ParameterValue]:
        """Return the values of those parameters that have one; the others are declared with a type, but no value."""
        try:
            return dict(zip(names, self.values(names), strict=True))
        except ParameterCommandError:
            if len(names) == 1:
                return {}
        half = len(names) // 2
        return {**self.settled_values(names[:half]), **self.settled_values(names[half:])}

    def descriptors(self, names: Sequence[str]) -> list[ParameterDescriptor]:
        """Return the descriptors. Raises NotFoundError for an unknown parameter."""
        request = srv.DescribeParameters.Request(names=names)
        found = list(self._call(srv.DescribeParameters, "describe_parameters", request).descriptors)
        if len(found) != len(names):
            self._check_known(names)
            raise ParameterCommandError(f"{self.name} does not describe {_listed(names)}")
        return found

    def set(self, parameters: Sequence[Parameter]) -> list[SetParametersResult]:
        """Set parameters one by one, and return a result for each."""
        request = srv.SetParameters.Request(parameters=parameters)
        results = list(self._call(srv.SetParameters, "set_parameters", request).results)
        if len(results) == 1 < len(parameters) and results[0].reason:
            raise ParameterCommandError(f"{self.name}/set_parameters: {shown(results[0].reason, 200)}")
        if len(results) != len(parameters):
            raise ParameterCommandError(
                f"{self.name}/set_parameters: expected {len(parameters)} results, got {len(results)}"
            )
        return results

    def _check_known(self, names: Sequence[str]) -> None:
        known = self.names()
        for each in names:
            if each not in known:
                raise NotFoundError("parameter", shown(each), known, self.name)

    def _call(self, srv_type: type[Any], name: str, request: Any) -> Any:
        client = self._asker.create_client(srv_type, f"{self.name}/{name}")
        try:
            return client.try_call(request, timeout_sec=ANSWER_WITHIN)
        except TimeoutError:
            raise ParameterCommandError(
                f"no answer within {ANSWER_WITHIN:g} s from {client.service_name}: does the node spin?"
            ) from None
        except ExternalShutdownException:
            raise KeyboardInterrupt from None
        finally:
            self._asker.destroy_client(client)


@contextmanager
def asking(node: str, timeout: float) -> Iterator[ParameterClient]:
    """Open a client of a node, by its full name or without its slash; wait `timeout` seconds for the node.

    Raises NotFoundError if it is not there, ParameterCommandError if it does not serve its parameters.
    """
    with looking() as context:
        name = absolute(node)
        if not serves(context, name, timeout):
            raise _absent(context, name)
        yield ParameterClient(node_of(context), name)


def serves(context: Context, name: str, timeout: float = 0.0) -> bool:
    """Wait up to `timeout` seconds for a node's parameter services; return True if they are there."""

    def is_there() -> bool:
        return context.graph.count(EndpointKind.SERVICE, f"{name}/set_parameters") > 0

    found = context.wait_until(is_there, timeout)
    if not context.ok():
        raise KeyboardInterrupt
    return found


def _absent(context: Context, name: str) -> RobolinkError:
    known = [each.full_node_name for each in context.graph.nodes()]
    if name in known:
        return ParameterCommandError(f"{name} has no parameter services: it was made without them")
    return ParameterCommandError(no_such_node(context, name, f"{name}/set_parameters", known))


def _listed(names: Sequence[str]) -> str:
    return ", ".join(f"'{shown(each)}'" for each in names)


class Requested(NamedTuple):
    """Options of `param list`: which parameters of which nodes, and if with their types."""

    prefixes: tuple[str, ...] = ()
    pattern: re.Pattern[str] | None = None
    types: bool = False
    hidden_nodes: bool = False


AnswerT = TypeVar("AnswerT")

Found = dict[str, str]
"""Names of parameters, each with its type, which is empty unless it is wanted."""


def compiled(pattern: str) -> re.Pattern[str] | None:
    """Compile the regular expression of `--filter`; end with a usage error if it is none."""
    try:
        return re.compile(pattern) if pattern else None
    except re.error as error:
        raise typer.BadParameter(f"--filter: no regular expression: {error}") from None


def show_list(node: str, requested: Requested, *, as_json: bool) -> None:
    """List the parameters of one node, or of all that serve them."""
    if node:
        with asking(node, 0.0) as client:
            found = {client.name: _names_and_types(client, requested)}
    else:
        found = _of_all(lambda client: _names_and_types(client, requested), requested.hidden_nodes)
    if as_json:
        say(messages.as_json({name: each if requested.types else list(each) for name, each in found.items()}))
        return
    for name, parameters in found.items():
        if not node and parameters:
            say(f"{name}:")
        for each, type_ in parameters.items():
            line = f"  {each} (type: {type_})" if requested.types else f"  {each}"
            say(fit(line, lines=False))


def _of_all(ask: Callable[[ParameterClient], AnswerT], hidden_nodes: bool) -> dict[str, AnswerT]:
    """Return the answer of every node, asked at once. Those that do not answer are noted on standard error."""
    from concurrent.futures import ThreadPoolExecutor

    with looking() as context:
        names = sorted({each.full_node_name for each in context.graph.nodes()})
        names = [name for name in names if serves(context, name) and (hidden_nodes or not is_hidden(name))]
        asker = node_of(context)
        with ThreadPoolExecutor(max_workers=max(1, min(32, len(names)))) as pool:
            futures = {name: pool.submit(ask, ParameterClient(asker, name)) for name in names}
        found = {}
        for name, future in futures.items():
            try:
                found[name] = future.result()
            except RobolinkError as error:
                tell(f"robolink: {name}: {error}")
    return found


def _names_and_types(client: ParameterClient, requested: Requested) -> Found:
    names = [
        each for each in client.names(requested.prefixes) if requested.pattern is None or requested.pattern.match(each)
    ]
    if not requested.types or not names:
        return dict.fromkeys(names, "")
    descriptors = client.descriptors(names)
    return {name: type_name(each.type) for name, each in zip(names, descriptors, strict=True)}


def show_values(node: str, parameters: Sequence[str], timeout: float, *, hide_type: bool, as_json: bool) -> None:
    """Show values of one node. Raises NotFoundError if it lacks one of the parameters."""
    with asking(node, timeout) as client:
        values = dict(zip(parameters, client.values(parameters), strict=True))
    if as_json:
        found = [_value_data(name, value) for name, value in values.items()]
        say(messages.as_json(found[0] if len(parameters) == 1 else found))
        return
    for name, value in values.items():
        text = _value_text(value, hide_type)
        say(text if len(parameters) == 1 else f"{name}:\n  {text}")


def show_value_of_all(parameter: str, *, hidden_nodes: bool, hide_type: bool, as_json: bool) -> None:
    """Show the value that each node has for a parameter; nodes that lack it are left out."""

    def ask(client: ParameterClient) -> dict[str, ParameterValue]:
        with contextlib.suppress(NotFoundError):
            return client.settled_values([parameter])
        return {}

    found = _of_all(ask, hidden_nodes)
    values = {node: each[parameter] for node, each in found.items() if each}
    if as_json:
        say(messages.as_json({node: _value_data(parameter, value) for node, value in values.items()}))
        return
    for node, value in values.items():
        say(f"{node}:\n  {_value_text(value, hide_type)}")
    if not values:
        say(f"Parameter '{shown(parameter)}' not set on any node")


def _value_data(name: str, value: ParameterValue) -> dict[str, Any]:
    return {"name": name, "type": type_name(value.type), "value": plain(value)}


def _value_text(value: ParameterValue, hide_type: bool) -> str:
    if value.type == Type.NOT_SET:
        return "Parameter not set."
    text = str(parameter_value_to_python(value))
    return text if hide_type else f"{label(value.type)} {text}"


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


UNCHANGED = "it is read-only and has this value already"


def set_each(node: str, texts: dict[str, str], timeout: float, *, as_json: bool) -> int:
    """Set parameters, and return the exit code. Each text is read as the type that its parameter has."""
    with asking(node, timeout) as client:
        # ros2 would refuse `1` for a double
        values = {name: read(text, _descriptor(client, name)) for name, text in texts.items()}
        made = [Parameter(name=name, value=value) for name, value in values.items()]
        results = dict(zip(texts, client.set(made), strict=True))
    for name, result in results.items():
        if result.successful:
            _tell_of_type(name, texts[name], get_parameter_value(texts[name]).type, values[name])
    if as_json and len(texts) > 1:
        say(messages.as_json({name: _plain(result) for name, result in results.items()}))
        return int(not all(each.successful for each in results.values()))
    codes = []
    for name, result in results.items():
        which = f"{name}: " if len(texts) > 1 else ""
        codes.append(_tell(result, as_json, f"{which}Set parameter successful", f"{which}Setting parameter failed"))
    return max(codes)


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
    requested = {name: fitting(value, descriptors.get(name)) for name, value in values.items()}
    results = dict.fromkeys(values, SetParametersResult(successful=True, reason=UNCHANGED))
    to_set = [name for name in values if name not in _unchanged(client, requested, descriptors)]
    given = client.set([Parameter(name=name, value=requested[name]) for name in to_set]) if to_set else []
    results.update(zip(to_set, given, strict=True))
    for name in to_set:
        if results[name].successful:
            _tell_of_type(name, values[name], fitting(values[name], None).type, requested[name])
    return results


def _unchanged(
    client: ParameterClient, requested: dict[str, ParameterValue], descriptors: dict[str, ParameterDescriptor]
) -> Iterable[str]:
    """Return the read-only parameters that have the wanted value already: a file that was dumped has those too."""
    fixed = [name for name, each in descriptors.items() if each.read_only]
    now = client.settled_values(fixed) if fixed else {}
    return {
        name for name, each in now.items() if (each.type, plain(each)) == (requested[name].type, plain(requested[name]))
    }


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


def of_node(ctx: Any, incomplete: str) -> list[str]:
    """Return the parameters of the node on the command line; nothing if it does not answer in time."""
    names: queue.SimpleQueue[list[str]] = queue.SimpleQueue()
    node = str(ctx.params.get("node") or "")
    # In the background, since neither the network nor the node need answer.
    threading.Thread(target=_ask, args=(node, names), name="robolink completion", daemon=True).start()
    with contextlib.suppress(queue.Empty):
        return offered(names.get(timeout=2 * WITHIN), incomplete)
    return []


def _ask(node: str, names: queue.SimpleQueue[list[str]]) -> None:
    context = Context()
    try:
        context.init(args=[])
        name = absolute(node)
        if serves(context, name):
            names.put(ParameterClient(node_of(context), name).names())
    except Exception:  # noqa: BLE001, S110 - there is nothing to offer, and nobody to tell
        pass
    finally:
        names.put([])
        context.try_shutdown()
