"""Actions that set what counts for the nodes behind them (`launch_ros.actions`)."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from robolink.arguments.parameter_file import parse_parameter_value
from robolink.exceptions import DocumentError, NameValidationException
from robolink.launch.ros.launch.bases import Action, LaunchContext, LaunchError, SomeSubstitutionsType, Substitution
from robolink.launch.ros.launch.inner_names import inner_names
from robolink.launch.ros.launch.substitutions import SubstitutionFailure
from robolink.launch.ros.launch.utilities import boolean, normalize_to_list_of_substitutions, perform_substitutions
from robolink.launch.ros.launch_ros.parameters import evaluate_parameter_dict, normalize_parameter_dict
from robolink.launch.ros.launch_ros.utilities import make_namespace_absolute, prefix_namespace
from robolink.system.terminal import shown
from robolink.validate_namespace import validate_namespace

NAMESPACE, REMAPS, PARAMETERS = "ros_namespace", "ros_remaps", "global_params"
"""Launch configurations in which they are stored, as in ROS 2."""
LOGS = "ROS_LOG_DIR"
"""Environment variable with the folder of the logs."""


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
        """Set it in `context`; raises SubstitutionFailure for an invalid one."""
        around = context.launch_configurations.get(NAMESPACE)
        pushed = perform_substitutions(context, self.namespace)
        whole = make_namespace_absolute(prefix_namespace(around, pushed)) or "/"
        try:
            validate_namespace(whole)
        except NameValidationException as error:
            within = f" within '{shown(around)}'" if around else ""
            raise SubstitutionFailure(f"namespace '{shown(pushed)}'{within}: {error.error_msg}") from None
        context.launch_configurations[NAMESPACE] = whole


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


@inner_names(param_dict="_normal")
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
        self._normal = normalize_parameter_dict({tuple(normalize_to_list_of_substitutions(name)): value})

    @property
    def name(self) -> tuple[Substitution, ...]:
        """The name, as substitutions that are one text."""
        return next(iter(self._normal))

    @property
    def value(self) -> Any:
        """The value, as `normalize_parameters` has it."""
        return self._normal[self.name]

    def execute(self, context: LaunchContext) -> None:
        """Set it in `context`. Raises LaunchError for a value that cannot be set so."""
        found = evaluate_parameter_dict(context, self._normal)
        for name, value in found.items():
            as_set(name, value)
            if isinstance(value, tuple):
                context.said.append(
                    f"SetParameter '{shown(name)}': a list arrives in ROS 2 as the text \"{shown(str(value))}\": "
                    "give it to the nodes as one of their parameters"
                )
        context.launch_configurations[PARAMETERS] = [
            *context.launch_configurations.get(PARAMETERS, []),
            *found.items(),
        ]


def as_set(name: str, value: Any) -> Any:
    """Return the value of the parameter `name` that a node gets for the `value` of SetParameter, a list for a tuple.

    Raises LaunchError for a text that rcl does not read behind `-p`.
    """
    if isinstance(value, tuple):
        return list(value)
    return _read(name, str(value)) if isinstance(value, (str, bytes)) else value


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

    def __init__(self, value: bool | SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.value = value

    def execute(self, context: LaunchContext) -> None:
        """Set it in a LaunchService; `robolink launch` has no such node, and says so in a line of `context`."""
        if context.asyncio_loop is None:
            context.said.append(
                "SetUseSimTime sets the clock of the launcher, and that of no node: "
                "SetParameter('use_sim_time', True) does"
            )
            return
        from robolink.launch.ros.launch_ros.ros_adapters import get_ros_node
        from robolink.parameter import Parameter

        value = boolean(context, self.value)
        get_ros_node(context).set_parameters([Parameter("use_sim_time", value=value)])


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


class SetROSLogDir(Action):
    """Set the folder of the logs of the nodes behind this.

    Args:
        new_log_dir: The folder, within the one before.
        **kwargs: `condition`.
    """

    def __init__(self, new_log_dir: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.log_dir = normalize_to_list_of_substitutions(new_log_dir)

    def execute(self, context: LaunchContext) -> None:
        """Set it in `context`."""
        from robolink.logging import get_logging_directory

        before = context.environment.get(LOGS) or str(get_logging_directory())
        context.environment[LOGS] = str(Path(before) / perform_substitutions(context, self.log_dir))


SetRosLogDir = SetROSLogDir
