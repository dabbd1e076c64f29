"""Action that starts a node (`launch_ros.actions.node`)."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from robolink.launch.ros.launch.actions import ExecuteProcess
from robolink.launch.ros.launch.bases import LaunchArgumentError, LaunchContext, LaunchError, SomeSubstitutionsType
from robolink.launch.ros.launch_ros.descriptions import take_old_names


class Node(ExecuteProcess):
    """Start a node.

    Args:
        executable: Name of the executable of the package; a path where no package is given.
        package: Name of the package.
        name: Name of the node; None leaves it to its program.
        namespace: Namespace, within those of PushRosNamespace.
        exec_name: Name for people.
        parameters: Mappings, parameter files and `Parameter`s, of which the later ones win.
        remappings: Pairs of a name and what stands for it.
        ros_arguments: Further words behind `--ros-args`.
        arguments: Words for its program.
        **kwargs: Those of ExecuteProcess, and arguments with their old names (`old_names.OLD_NAMES`).
    """

    def __init__(
        self,
        *,
        executable: SomeSubstitutionsType | None = None,
        package: SomeSubstitutionsType | None = None,
        name: SomeSubstitutionsType | None = None,
        namespace: SomeSubstitutionsType | None = None,
        exec_name: SomeSubstitutionsType | None = None,
        parameters: Iterable[Any] | None = None,
        remappings: Iterable[tuple[SomeSubstitutionsType, SomeSubstitutionsType]] | None = None,
        ros_arguments: Iterable[SomeSubstitutionsType] | None = None,
        arguments: Iterable[SomeSubstitutionsType] | None = None,
        **kwargs: Any,
    ) -> None:
        named: dict[str, Any] = {"executable": executable, "name": name, "namespace": namespace}
        self.old_names = take_old_names(type(self).__name__, named, kwargs)
        self.node_executable = named["executable"]
        if self.node_executable is None:
            raise LaunchArgumentError(f"{type(self).__name__} needs an executable=...")
        self.node_package, self.exec_name = package, exec_name
        self.requested_name, self.requested_namespace = named["name"], named["namespace"]
        if isinstance(parameters, (str, dict)):
            raise LaunchArgumentError(f"Node's parameters are a list, as in [{parameters!r:.60}]")
        self.parameters, self.remappings = list(parameters or ()), list(remappings or ())
        self.ros_arguments, self.arguments = _words(ros_arguments), _words(arguments)
        self.expanded_name: str | None = None
        super().__init__(cmd=[self.node_executable, *self.arguments], name=exec_name, **kwargs)

    def prepare(self, context: LaunchContext) -> None:
        """Leave it to the launcher: it finds the program, then performs the rest with the values of `context`."""

    @property
    def node_name(self) -> str:
        """Full name of the node, once it was executed; raises LaunchError before."""
        if self.expanded_name is None:
            raise LaunchError("a node's name is known once it is executed")
        return self.expanded_name


def _words(given: Any) -> list[Any]:
    """Return arguments as a list: many launch files give a lone text, and ROS 2 splits none of them."""
    if given is None:
        return []
    return [given] if isinstance(given, str) else list(given)
