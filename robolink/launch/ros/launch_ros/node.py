"""Action that starts a node (`launch_ros.actions.node`)."""

from __future__ import annotations

import atexit
import tempfile
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import yaml

from robolink.documents.yamlfile import spell
from robolink.launch.ros.launch.actions import ExecuteProcess
from robolink.launch.ros.launch.bases import (
    LaunchArgumentError,
    LaunchContext,
    LaunchError,
    SomeSubstitutionsType,
    Substitution,
)
from robolink.launch.ros.launch.inner_names import inner_names
from robolink.launch.ros.launch.substitutions import LocalSubstitution
from robolink.launch.ros.launch.utilities import normalize_to_list_of_substitutions, performed
from robolink.launch.ros.launch_ros.descriptions import take_old_names
from robolink.launch.ros.launch_ros.parameter_descriptions import Parameter
from robolink.launch.ros.launch_ros.settings import NAMESPACE, PARAMETERS, REMAPS
from robolink.launch.ros.launch_ros.substitutions import ExecutableInPackage
from robolink.launch.ros.launch_ros.utilities import (
    add_node_name,
    evaluate_parameters,
    get_node_name_count,
    given_remappings,
    make_namespace_absolute,
    normalize_parameters,
    prefix_namespace,
)
from robolink.validate_namespace import validate_namespace
from robolink.validate_node_name import validate_node_name

SPECIFIC = "ros_specific_arguments"
"""Local of the context with the words for a node's name and namespace, as in ROS 2."""


class Names(NamedTuple):
    """Names of a node as far as its action says them.

    Args:
        name: Its name; None if the action has none.
        namespace: The namespace within those around, with a slash in front; None if the action has none.
    """

    name: str | None
    namespace: str | None


@inner_names(
    "node_executable",
    "parameters",
    "remappings",
    "arguments",
    "ros_arguments",
    package="node_package",
    node_name="requested_name",
    node_namespace="requested_namespace",
    expanded_node_name="_expanded_node_name",
    expanded_node_namespace="expanded_node_namespace",
    expanded_parameter_arguments="_parameter_arguments",
    expanded_remappings="_expanded_remappings",
    extensions="_extensions",
)
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
        **kwargs: Those of ExecuteProcess, and arguments with their old names (`descriptions.OLD_NAMES`).
    """

    UNSPECIFIED_NODE_NAME = "<node_name_unspecified>"
    UNSPECIFIED_NODE_NAMESPACE = "<node_namespace_unspecified>"

    def __init__(
        self,
        *,
        executable: SomeSubstitutionsType | None = None,
        package: SomeSubstitutionsType | None = None,
        name: SomeSubstitutionsType | None = None,
        namespace: SomeSubstitutionsType | None = None,
        exec_name: SomeSubstitutionsType | None = None,
        parameters: Sequence[Any] | None = None,
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
        self.parameters = normalize_parameters(() if parameters is None else parameters)
        self.remappings = given_remappings(remappings or ())
        self.ros_arguments, self.arguments = _words(ros_arguments), _words(arguments)
        self.expanded_name: str | None = None
        """Full name under which the launcher started it: that of its program where the launch file gives it none."""
        self._names: Names | None = None
        self._expanded_remappings: list[tuple[str, str]] | None = None
        self._parameter_arguments: list[tuple[str, bool]] | None = None
        """Values and files of parameters, and whether each is a file, once `_perform_substitutions` was called."""
        self._extensions: dict[str, Any] = {}
        """Extensions of ROS 2's Node: none, robolink loads none."""
        self._command: list[list[Substitution]] | None = None
        super().__init__(cmd=[self.node_executable, *self.arguments], name=exec_name, **kwargs)

    def prepare(self, context: LaunchContext) -> None:
        """Leave it to the launcher: it finds the program, then performs the rest with the values of `context`."""

    @property
    def node_name(self) -> str:
        """Full name of the node, once it was executed: what the launch file leaves open is `UNSPECIFIED_NODE_NAME`.

        Raises LaunchError before.
        """
        if self._names is None:
            if self.expanded_name is not None:
                return self.expanded_name
            raise LaunchError("a node's name is known once it is executed")
        name = self._expanded_node_name
        return prefix_namespace(self.expanded_node_namespace, name) or name

    @property
    def _expanded_node_name(self) -> str:
        known = None if self._names is None else self._names.name
        return self.UNSPECIFIED_NODE_NAME if known is None else known

    @property
    def expanded_node_namespace(self) -> str:
        """Namespace of the node, once it was executed; `UNSPECIFIED_NODE_NAMESPACE` where nothing gives it one."""
        known = None if self._names is None else self._names.namespace
        return self.UNSPECIFIED_NODE_NAMESPACE if known is None else known

    @property
    def expanded_remapping_rules(self) -> list[tuple[str, str]] | None:
        """Remappings of the node, once it was executed, those of SetRemap first; None for none."""
        return self._expanded_remappings

    def is_node_name_fully_specified(self) -> bool:
        """Return whether the launch file gives the node both a name and a namespace. Raises LaunchError."""
        left_open = (self.UNSPECIFIED_NODE_NAME, self.UNSPECIFIED_NODE_NAMESPACE)
        return not any(each in self.node_name for each in left_open)

    @property
    def cmd(self) -> list[Any]:
        """The command line by which ROS 2 starts it, each word as substitutions."""
        if self._command is None:
            program: Any = self.node_executable
            if self.node_package is not None:
                program = ExecutableInPackage(package=self.node_package, executable=program)
            words = [program, *self.arguments, *(["--ros-args", *self.ros_arguments] if self.ros_arguments else [])]
            named = [] if self.requested_name is None else ["-r", LocalSubstitution(f"{SPECIFIC}['name']", "node name")]
            self._command = _normal([*words, "--ros-args", *named])
        return self._command

    def execute(self, context: LaunchContext) -> None:
        """Note the names of the node in `context`, and leave it to the launcher, which sees all executed actions."""
        self._expand(context)
        super().execute(context)
        if self.is_node_name_fully_specified():
            note_name(context, self.node_name)

    def _expand(self, context: LaunchContext) -> None:
        """Perform what names it, and its remappings, with the values of `context`."""
        name = None if self.requested_name is None else performed(context, self.requested_name)
        own = None if self.requested_namespace is None else performed(context, self.requested_namespace)
        around = context.launch_configurations.get(NAMESPACE)
        namespace = make_namespace_absolute(prefix_namespace(around, own))
        self._names = Names(name, namespace)
        pairs = list(context.launch_configurations.get(REMAPS, ()))
        pairs += [(performed(context, match), performed(context, new)) for match, new in _pairs(self.remappings)]
        self._expanded_remappings = pairs or None

    def _perform_substitutions(self, context: LaunchContext) -> None:
        """Complete `cmd` with the values of `context`, as programs that extend ROS 2's Node expect.

        robolink's launcher does not need it: it hands names and parameters over by itself. Parameters are written to
        files, which are removed when this process ends.

        Raises:
            InvalidNodeNameException, InvalidNamespaceException: for such names.
            LaunchError: for a value that no parameter can have.
        """
        self._command = None
        self._expand(context)
        assert self._names is not None
        words: list[Any] = []
        if self._names.name is not None:
            validate_node_name(self._names.name)
        if self._names.namespace is not None:
            validate_namespace(self._names.namespace)
            words += ["-r", LocalSubstitution(f"{SPECIFIC}['ns']")]
        self._parameter_arguments = []
        for each in context.launch_configurations.get(PARAMETERS, ()):
            is_value = isinstance(each, tuple)
            words += ["-p", f"{each[0]}:={each[1]}"] if is_value else self._noted(str(Path(each).absolute()), True)
        for each in evaluate_parameters(context, self.parameters):
            words += self._noted(*self._argument(each, context))
        for match, new in self._expanded_remappings or ():
            words += ["-r", f"{match}:={new}"]
        self.cmd.extend(_normal(words))

    def _noted(self, text: str, is_file: bool) -> list[str]:
        """Return the words for a parameter, or a file of them, after noting it."""
        assert self._parameter_arguments is not None
        self._parameter_arguments.append((text, is_file))
        return ["--params-file" if is_file else "-p", text]

    def _argument(self, parameters: Any, context: LaunchContext) -> tuple[str, bool]:
        """Return the word of a command line for parameters, and whether it is a file."""
        if isinstance(parameters, Parameter):
            name, value = parameters.evaluate(context)
            return f"{name}:={spell(value)}", False
        if isinstance(parameters, Path):
            return str(parameters), True
        node = self.node_name if self.is_node_name_fully_specified() else "/**"
        values = {name: list(value) if isinstance(value, tuple) else value for name, value in parameters.items()}
        with tempfile.NamedTemporaryFile("w", prefix="launch_params_", encoding="utf-8", delete=False) as file:
            yaml.safe_dump({node: {"ros__parameters": values}}, file, default_flow_style=False)
        atexit.register(Path(file.name).unlink, missing_ok=True)
        return file.name, True


def note_name(context: LaunchContext, node_name: str) -> None:
    """Count one more node with the full name `node_name` in `context`, with a line about a name that several have."""
    add_node_name(context, node_name)
    count = get_node_name_count(context, node_name)
    if count > 1:
        text = f"there are now at least {count} nodes with the name {node_name} created within this launch context"
        context.said.append(text)


def _pairs(remappings: Iterable[Any]) -> list[Any]:
    return [each for each in remappings if isinstance(each, tuple)]


def _normal(words: Iterable[Any]) -> list[list[Substitution]]:
    texts = (str(each) if isinstance(each, (int, float)) else each for each in words)
    return [normalize_to_list_of_substitutions(each) for each in texts]


def _words(given: Any) -> list[Any]:
    """Return arguments as a list: many launch files give a lone text, and ROS 2 splits none of them."""
    if given is None:
        return []
    return [given] if isinstance(given, str) else list(given)
