"""Actions that start nodes, and that set what counts for the nodes behind them (`launch_ros.actions`)."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Any

from robolink.arguments.parameter_file import parse_parameter_value
from robolink.exceptions import DocumentError
from robolink.launch.ros.launch.actions import (
    EmitEvent,
    ExecuteProcess,
    RegisterEventHandler,
    SetEnvironmentVariable,
    TimerAction,
)
from robolink.launch.ros.launch.bases import (
    Action,
    LaunchArgumentError,
    LaunchContext,
    LaunchDescriptionEntity,
    LaunchError,
    SomeSubstitutionsType,
)
from robolink.launch.ros.launch.utilities import (
    normalize_to_list_of_substitutions,
    perform_substitutions,
    performed,
)
from robolink.launch.ros.launch_ros.descriptions import ComposableNode, plain, take_old_names
from robolink.launch.ros.launch_ros.events import (
    ChangeState,
    OnStateTransition,
    StateTransition,
    full_name,
    matches_node_name,
)
from robolink.system.terminal import shown

__all__ = [
    "ComposableNodeContainer",
    "LifecycleNode",
    "LifecycleTransition",
    "LoadComposableNodes",
    "Node",
    "PushROSNamespace",
    "PushRosNamespace",
    "ROSTimer",
    "RosTimer",
    "SetParameter",
    "SetParametersFromFile",
    "SetROSLogDir",
    "SetRemap",
    "SetRosLogDir",
    "SetUseSimTime",
]


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


class ComposableNodeContainer(Node):
    """Process of C++ that loads nodes as plugins.

    Args:
        name: Name of the container; it must be given.
        namespace: Its namespace.
        composable_node_descriptions: The nodes in it.
        **kwargs: Those of Node.
    """

    def __init__(
        self,
        *,
        name: SomeSubstitutionsType | None = None,
        namespace: SomeSubstitutionsType | None = None,
        composable_node_descriptions: Iterable[ComposableNode] | None = None,
        **kwargs: Any,
    ) -> None:
        super().__init__(name=name, namespace=namespace, **kwargs)
        if self.requested_name is None:
            raise LaunchArgumentError("ComposableNodeContainer needs name=...")
        self.composable_node_descriptions = list(composable_node_descriptions or ())


class LoadComposableNodes(Action):
    """Load nodes of C++ into a container that runs.

    Args:
        composable_node_descriptions: The nodes.
        target_container: The container, or its name.
        **kwargs: `condition`.
    """

    def __init__(
        self,
        *,
        composable_node_descriptions: Iterable[ComposableNode],
        target_container: SomeSubstitutionsType | ComposableNodeContainer,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self.composable_node_descriptions = list(composable_node_descriptions)
        self.target_container = target_container


class LifecycleNode(Node):
    """Start a node with a lifecycle.

    Args:
        name: Name of the node; it must be given.
        namespace: Namespace of the node; it must be given.
        autostart: True configures and activates it once it is there.
        **kwargs: Those of Node.
    """

    def __init__(
        self,
        *,
        name: SomeSubstitutionsType | None = None,
        namespace: SomeSubstitutionsType | None = None,
        autostart: bool | SomeSubstitutionsType = False,
        **kwargs: Any,
    ) -> None:
        super().__init__(name=name, namespace=namespace, **kwargs)
        for needed, value in (("name", self.requested_name), ("namespace", self.requested_namespace)):
            if value is None:
                raise LaunchArgumentError(f"LifecycleNode needs {needed}=...")
        self.autostart = autostart


class LifecycleTransition(Action):
    """Ask nodes with a lifecycle for transitions.

    Args:
        lifecycle_node_names: Full names of the nodes.
        transition_ids: The transitions, in their order (`lifecycle_msgs.msg.Transition`).
        **kwargs: `condition`.
    """

    def __init__(
        self,
        *,
        lifecycle_node_names: Iterable[SomeSubstitutionsType],
        transition_ids: Iterable[int | SomeSubstitutionsType],
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self.lifecycle_node_names, self.transition_ids = list(lifecycle_node_names), list(transition_ids)
        if not self.lifecycle_node_names or not self.transition_ids:
            raise LaunchArgumentError("LifecycleTransition needs names of nodes, and transitions")

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity]:
        """Return the actions that ask each node for the first transition, and for each further one once it is there."""
        ids = [transition_of(each, context) for each in self.transition_ids]
        names = [full_name(performed(context, each)) for each in self.lifecycle_node_names]
        return [each for name in names for each in transitions(name, ids)]


def transitions(name: str, ids: Sequence[int]) -> list[LaunchDescriptionEntity]:
    """Return the actions that bring the node `name` through the transitions `ids`, one after the other."""
    asks = [EmitEvent(event=_request_of(name, each)) for each in ids]
    handlers: list[LaunchDescriptionEntity] = [
        RegisterEventHandler(OnStateTransition(matcher=_reaches(name, before), entities=[ask], handle_once=True))
        for before, ask in zip(ids, asks[1:], strict=False)
    ]
    return [*handlers, asks[0]]


def _request_of(name: str, transition_id: int) -> ChangeState:
    event = ChangeState(lifecycle_node_matcher=matches_node_name(name), transition_id=transition_id)
    event.node_name = name
    return event


def transition_of(given: Any, context: LaunchContext) -> int:
    """Return the number of a transition, which may be `given` as one, as its text or its label.

    Substitutions are performed with the values of `context`. Raises LaunchError for one that there is not.
    """
    text = str(given) if isinstance(given, int) else performed(context, given).strip()
    number = _BY_LABEL.get(text, text)
    if str(number) not in map(str, _GOALS):
        raise LaunchError(f"a transition is one of {', '.join(_BY_LABEL)}, or its number, got '{shown(text)}'")
    return int(number)


def _reaches(name: str, transition_id: int) -> Callable[[Any], bool]:
    """Return a function that is true for the event that a node has reached the goal of a transition."""
    goal, is_node = _GOALS[transition_id], matches_node_name(name)
    return lambda event: isinstance(event, StateTransition) and is_node(event.action) and event.goal_state == goal


_BY_LABEL = {"configure": 1, "cleanup": 2, "activate": 3, "deactivate": 4, "shutdown": 5}
_GOALS = {1: "inactive", 2: "unconfigured", 3: "active", 4: "inactive", 5: "finalized", 6: "finalized", 7: "finalized"}
"""State that each transition leads to, by its number."""


NAMESPACE, REMAPS, PARAMETERS = "ros_namespace", "ros_remaps", "global_params"
"""Launch configurations in which they are stored, as in ROS 2."""


def joined(around: str, namespace: str) -> str:
    """Return a namespace within the one around it; one with a slash in front stays as it is.

    Args:
        around: The namespace around, '' or with a slash in front.
        namespace: The namespace, '' for none.

    >>> joined("/fleet", "ada"), joined("/fleet", "/ada"), joined("", "")
    ('/fleet/ada', '/ada', '')
    """
    is_whole = not namespace or namespace.startswith("/")
    whole = namespace or around if is_whole else f"{around.rstrip('/')}/{namespace}"
    return whole.rstrip("/")


class PushROSNamespace(Action):
    """Put a namespace in front of the nodes behind this.

    Args:
        namespace: The namespace, within the one around.
        **kwargs: `condition`.
    """

    def __init__(self, namespace: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.namespace = normalize_to_list_of_substitutions(namespace)

    def execute(self, context: LaunchContext) -> None:
        """Set it in `context`."""
        around = str(context.launch_configurations.get(NAMESPACE, ""))
        context.launch_configurations[NAMESPACE] = joined(around, perform_substitutions(context, self.namespace))


PushRosNamespace = PushROSNamespace


class SetRemap(Action):
    """Remap a name of the nodes behind this; it counts more than their own remappings.

    Args:
        src: The name.
        dst: What stands for it.
        **kwargs: `condition`.
    """

    def __init__(self, src: SomeSubstitutionsType, dst: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.src, self.dst = normalize_to_list_of_substitutions(src), normalize_to_list_of_substitutions(dst)

    def execute(self, context: LaunchContext) -> None:
        """Set it in `context`."""
        pair = perform_substitutions(context, self.src), perform_substitutions(context, self.dst)
        context.launch_configurations[REMAPS] = [*context.launch_configurations.get(REMAPS, []), pair]


class SetParameter(Action):
    """Set a parameter of the nodes behind this; their own parameters count more.

    ROS 2 passes it as `-p NAME:=VALUE`, so that rcl reads a text as it reads that of a command line: "1" is a number.

    Args:
        name: Its name.
        value: Its value, as in a node's parameters.
        **kwargs: `condition`.
    """

    def __init__(self, name: SomeSubstitutionsType, value: Any, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.name, self.value = normalize_to_list_of_substitutions(name), value

    def execute(self, context: LaunchContext) -> None:
        """Set it in `context`."""
        name, value = perform_substitutions(context, self.name), plain(self.value, context)
        if isinstance(value, str):
            value = _read(name, value)
        elif isinstance(value, list):
            context.said.append(
                f"SetParameter '{shown(name)}': a list arrives in ROS 2 as the text \"{shown(str(tuple(value)))}\": "
                "give it to the nodes as one of their parameters"
            )
        context.launch_configurations[PARAMETERS] = [*context.launch_configurations.get(PARAMETERS, []), (name, value)]


def _read(name: str, text: str) -> Any:
    """Return rcl's value of a parameter's text behind `-p`. Raises LaunchError."""
    try:
        return parse_parameter_value(text, "")
    except DocumentError as error:
        raise LaunchError(f"parameter '{shown(name)}': '{shown(text)}' cannot be set so: {error.message}") from None


class SetUseSimTime(Action):
    """Set the parameter `use_sim_time` of the launcher's own node, and of no other, as in ROS 2.

    Args:
        value: True for the time of /clock.
        **kwargs: `condition`.
    """

    def __init__(self, value: bool, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.value = value

    def execute(self, context: LaunchContext) -> None:
        """Add a line to `context` that says so: the launcher's own node has no timers here."""
        context.said.append(
            "SetUseSimTime sets the clock of the launcher, and that of no node: SetParameter('use_sim_time', True) does"
        )


class SetParametersFromFile(Action):
    """Set the parameters of a file for the nodes behind this.

    Args:
        filename: Path of the file.
        **kwargs: `condition`.
    """

    def __init__(self, filename: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.filename = normalize_to_list_of_substitutions(filename)

    def execute(self, context: LaunchContext) -> None:
        """Set them in `context`."""
        path = perform_substitutions(context, self.filename)
        context.launch_configurations[PARAMETERS] = [*context.launch_configurations.get(PARAMETERS, []), path]


class SetROSLogDir(SetEnvironmentVariable):
    """Set the folder of the logs of the nodes behind this.

    Args:
        new_log_dir: The folder.
        **kwargs: `condition`.
    """

    def __init__(self, new_log_dir: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__("ROS_LOG_DIR", new_log_dir, **kwargs)


class ROSTimer(TimerAction):
    """Actions for later, by the launcher's own time: it has no /clock."""


RosTimer = ROSTimer
SetRosLogDir = SetROSLogDir
