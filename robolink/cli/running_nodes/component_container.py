"""Container of components, as in rclcpp_components: a process into which services load nodes in Python."""

from __future__ import annotations

import contextlib
import itertools
import re
from typing import TYPE_CHECKING, Any

from robolink.cli.running_nodes import container
from robolink.documents.yamlfile import spell
from robolink.exceptions import ExternalShutdownException, NotFoundError, RobolinkError
from robolink.executors import Executor, MultiThreadedExecutor, SingleThreadedExecutor
from robolink.interfaces.composition_interfaces.srv import ListNodes, LoadNode, UnloadNode
from robolink.launch.shared_process import Member
from robolink.node import Node
from robolink.parameter import Parameter
from robolink.workspace import NodeLoadError, NodeSource, component, find_executable, own_process_needed

if TYPE_CHECKING:
    from robolink.context import Context

LEVELS = {10: "debug", 20: "info", 30: "warn", 40: "error", 50: "fatal"}
"""Log levels by number, as rcl_interfaces/msg/Log has them."""


def main() -> None:
    """Run a container whose nodes take turns."""
    _run(SingleThreadedExecutor)


def main_mt() -> None:
    """Run a container whose nodes have several threads."""
    _run(MultiThreadedExecutor)


def _run(executor_class: type[Executor]) -> None:
    import robolink

    with robolink.init() as begun, contextlib.suppress(KeyboardInterrupt, ExternalShutdownException):
        executor = executor_class(context=begun.context)
        manager = ComponentManager(executor)
        try:
            executor.spin()
        finally:
            manager.unload_all()


class ComponentManager(Node):
    """Node of a container: loads nodes into the container's executor, and takes them out."""

    def __init__(self, executor: Executor) -> None:
        super().__init__("ComponentManager")
        self._loads_into = executor
        self._loaded: dict[int, Node] = {}
        self._numbers = itertools.count(1)
        self.create_service(LoadNode, "~/_container/load_node", self._load)
        self.create_service(UnloadNode, "~/_container/unload_node", self._unload)
        self.create_service(ListNodes, "~/_container/list_nodes", self._list)
        executor.add_node(self)

    def unload_all(self) -> None:
        """Destroy all nodes, and this one."""
        for each in (*self._loaded.values(), self):
            each.destroy_node()

    def _load(self, request: LoadNode.Request, response: LoadNode.Response) -> LoadNode.Response:
        try:
            node = self._made(request, self.context)
        except Exception as error:  # noqa: BLE001 - the node is anybody's, and the container goes on
            response.error_message = (
                f"{error}" if isinstance(error, RobolinkError) else f"{type(error).__name__}: {error}"
            )
            self.get_logger().error(f"{request.package_name} {request.plugin_name}: {response.error_message}")
            return response
        number = next(self._numbers)
        self._loaded[number] = node
        self._loads_into.add_node(node)
        response.success, response.unique_id = True, number
        response.full_node_name = node.get_fully_qualified_name()
        self.get_logger().info(f"loaded {request.package_name} {request.plugin_name} as {response.full_node_name}")
        return response

    def _made(self, request: LoadNode.Request, context: Context) -> Node:
        source = source_of(request.package_name, request.plugin_name)
        own, before = context.arguments, set(context._nodes)
        try:
            return container.make(Member(source.name, source.spec, arguments_of(request)), source, context)
        except BaseException:
            for half_made in set(context._nodes) - before:
                context._nodes[half_made].destroy_node()
            raise
        finally:
            context.arguments = own

    def _unload(self, request: UnloadNode.Request, response: UnloadNode.Response) -> UnloadNode.Response:
        node = self._loaded.pop(request.unique_id, None)
        response.success = node is not None
        if node is None:
            response.error_message = f"no node has the number {request.unique_id}"
        else:
            self._loads_into.remove_node(node)
            node.destroy_node()
        return response

    def _list(self, _: ListNodes.Request, response: ListNodes.Response) -> ListNodes.Response:
        response.unique_ids = list(self._loaded)
        response.full_node_names = [each.get_fully_qualified_name() for each in self._loaded.values()]
        return response


def source_of(package: str, plugin: str) -> NodeSource:
    """Return the source of a component: an executable of a package, also by a type of C++ such as ``demo::TalkerNode``.

    Args:
        package: Name of the package.
        plugin: Name of the executable, or the type.

    Raises:
        NotFoundError: if there is no such executable.
        NodeLoadError: if it is not a Node class.
    """
    if (known := component(plugin)) is not None:
        return known
    try:
        source = find_executable(package, plugin)
    except NotFoundError:
        source = find_executable(package, re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", plugin.rpartition("::")[2]).lower())
    if why := own_process_needed(source):
        raise NodeLoadError(f"{package} {plugin} shares no process: {why.partition(': ')[0]}")
    return source


def arguments_of(request: LoadNode.Request) -> list[str]:
    """Return the arguments of a node that it would have alone, for a `request` to load it."""
    words = ["--ros-args"]
    if request.node_name:
        words += ["-r", f"__node:={request.node_name}"]
    if request.node_namespace:
        words += ["-r", f"__ns:=/{request.node_namespace.strip('/')}"]
    for rule in request.remap_rules:
        words += ["-r", rule]
    for each in request.parameters:
        parameter: Parameter[Any] = Parameter.from_parameter_msg(each)
        words += ["-p", f"{parameter.name}:={spell(parameter.value)}"]
    return words + (["--log-level", LEVELS[request.log_level]] if request.log_level in LEVELS else [])
