"""Parameters of Nav2's files: those that robolink has no use for are kept, and named once in the log."""

from __future__ import annotations

from robolink.interfaces.rcl_interfaces.msg import ParameterDescriptor
from robolink.node import Node

MOST = 12
"""Largest number of names in the warning."""

UNUSED = ParameterDescriptor(description="given, and without effect in robolink", dynamic_typing=True)


def keep_unknown(node: Node, *, except_below: tuple[str, ...] = (), is_child: bool = False) -> list[str]:
    """Declare the parameters that a node was given and does not have, and log one warning that names them.

    Call it at the end of `on_configure`, when all that the node knows is declared. A file that was written for Nav2 so
    works as it is, `robolink param get` shows all of its values, and whoever wrote it learns what has no effect.

    Args:
        node: The node.
        except_below: Names of parts, such as `local_costmap`, whose parameters will be declared later.
        is_child: True for a node that another one makes: what was given for all nodes of the program, which is how
            launch files give it, is that one's.

    Returns:
        The names, sorted.
    """
    later = tuple(f"{each}." for each in (*except_below, "qos_overrides"))
    given = node._parameter_overrides
    names = sorted(name for name in given if not node.has_parameter(name) and not name.startswith(later))
    if is_child:
        full_name = node.get_fully_qualified_name()
        overrides = node._arguments_.parameter_overrides
        by_name = {each.name for each in overrides if "*" not in each.pattern and each.is_for(full_name)}
        names = [each for each in names if each in by_name]
    for name in names:
        node.declare_parameter(name, given[name].value, UNUSED)
    if names:
        rest = f" and {len(names) - MOST} more" if len(names) > MOST else ""
        node.get_logger().warning(f"parameters without effect in robolink: {', '.join(names[:MOST])}{rest}")
    return names
