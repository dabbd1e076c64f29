"""Shared process: several nodes with one session and one executor, but each with arguments of its own.

They share what Python has once a process: modules (two nodes of one file share what stands outside
of their class), the working directory, and the environment.
"""

from __future__ import annotations

import contextlib
import sys
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from robolink.cli.running_nodes import runner
from robolink.cli.shared.output import tell
from robolink.exceptions import ExternalShutdownException, RobolinkError
from robolink.launch.shared_process import Member
from robolink.workspace import NodeLoadError, NodeSource, find_node, load_node
from robolink.workspace.load import make_node, runs_itself

if TYPE_CHECKING:
    from robolink.context import Context
    from robolink.node import Node


def run(members: Sequence[Member]) -> int:
    """Run nodes until their context ends, and return the exit code, which is that of `robolink run`.

    They end together: with the first callback that raises, with `shutdown`, Ctrl-C or SIGTERM.
    """
    sources = [find_node(each.node) for each in members]
    if sources:
        runner.settle(sources[0], None)
    runner.take_names()
    runner.pass_over_imports()
    terminated = runner.prepare()
    return runner.outcome(lambda: _spin(members, sources), terminated)


def _spin(members: Sequence[Member], sources: Sequence[NodeSource]) -> None:
    import robolink
    from robolink.arguments.command_line import Arguments

    with (
        robolink.init(args=[]) as begun,
        contextlib.suppress(KeyboardInterrupt, ExternalShutdownException),
        contextlib.ExitStack() as stack,
    ):
        executor = robolink.get_global_executor()  # what a node gets that spins itself
        nodes: dict[int, str] = {}
        for member, source in zip(members, sources, strict=True):
            node = make(member, source, begun.context)
            stack.callback(node.destroy_node)
            executor.add_node(node)
            nodes[id(node)] = member.name
        # Which node would make another one later, in a callback, cannot be told: that one gets no arguments.
        begun.context.arguments, sys.argv = Arguments(), sys.argv[:1]
        try:
            executor.spin()
        except Exception as error:
            if name := _whose(error, nodes):
                tell(f"robolink: {name} raised in a callback:")
            raise


def _whose(error: Exception, nodes: Mapping[int, str]) -> str:
    """Return the name of the node in whose method an exception was raised; '' if it is none's.

    A traceback says the file and the line, which are the same for all nodes of a class.
    """
    trace, found = error.__traceback__, ""
    while trace is not None:
        found = nodes.get(id(trace.tb_frame.f_locals.get("self")), found)
        trace = trace.tb_next
    return found


def make(member: Member, source: NodeSource, context: Context) -> Node:
    """Make a node with the command line that it would have alone.

    Raises NodeLoadError, which begins with the node's name, for errors of robolink. Those of the user's code pass,
    after a line on standard error with that name.
    """
    from robolink.arguments.command_line import parse_arguments
    from robolink.logging import set_logger_level

    sys.argv = [str(source.path or source.name), *member.args]
    try:
        context.arguments = parse_arguments(sys.argv)
        node = make_node(_node_class(source))
    except ExternalShutdownException:
        raise
    except RobolinkError as error:
        raise NodeLoadError(f"{member.name}: {error}").with_traceback(error.__traceback__) from None
    except Exception:
        tell(f"robolink: {member.name} raised while it was made:")
        raise
    for name, level in context.arguments.log_levels:
        set_logger_level(name or node.get_logger().name, level)
    return node


def _node_class(source: NodeSource) -> type[Node]:
    found = load_node(source)
    if not isinstance(found, type) or runs_itself(found):
        what = "an AsyncNode class" if isinstance(found, type) else "not a Node class"
        raise NodeLoadError(f"{source.spec} is {what}, and needs a process of its own: leave `process` out")
    return found
