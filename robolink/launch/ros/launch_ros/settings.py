"""Actions that set what counts for the nodes behind them (`launch_ros.actions`)."""

from __future__ import annotations

from typing import Any

from robolink.arguments.parameter_file import parse_parameter_value
from robolink.exceptions import DocumentError
from robolink.launch.ros.launch.actions import SetEnvironmentVariable
from robolink.launch.ros.launch.bases import Action, LaunchContext, LaunchError, SomeSubstitutionsType
from robolink.launch.ros.launch.utilities import normalize_to_list_of_substitutions, perform_substitutions
from robolink.launch.ros.launch_ros.descriptions import plain
from robolink.system.terminal import shown

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


SetRosLogDir = SetROSLogDir
