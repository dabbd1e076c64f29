"""Table of the actions that XML and YAML launch files have: a function for each class, which reads its arguments."""

from __future__ import annotations

import functools
from collections.abc import Callable, Collection
from dataclasses import dataclass
from typing import Any, List, TypeAlias, TypeVar  # noqa: UP035 - ROS 2 names its list types by it

from robolink.launch.ros.launch import actions
from robolink.launch.ros.launch.bases import Action, Condition, LaunchError, Substitution
from robolink.launch.ros.launch.conditions import IfCondition, UnlessCondition
from robolink.launch.ros.launch.frontend.entity import Entity, placing
from robolink.launch.ros.launch.frontend.expose import Method
from robolink.launch.ros.launch.frontend.parse_substitution import words_of
from robolink.launch.ros.launch.frontend.parser import Parser
from robolink.launch.ros.launch.frontend.type_utils import get_data_type_from_identifier
from robolink.launch.ros.launch.utilities import as_node_reads, coerced
from robolink.launch.ros.launch_ros import actions as ros
from robolink.launch.ros.launch_ros.descriptions import ComposableNode, ParameterFile, ParameterValue

T = TypeVar("T")
Arguments: TypeAlias = "dict[str, Any]"


@dataclass
class Reading:
    """Reader of an element's attributes.

    Args:
        entity: The element.
        parser: Parser of its texts, and of the elements in it.
        ignored: Attributes that are left to a subclass of the action.
    """

    entity: Entity
    parser: Parser
    ignored: Collection[str] = ()

    def value(self, name: str, data_type: Any = str) -> Any:
        """Return the value of an attribute, `name`, of a type, or its text; None if it is not there."""
        if name in self.ignored:
            return None
        return self.entity.get_attr(name, data_type=data_type, optional=True)

    def parsed(self, name: str, data_type: Any = str) -> Any:
        """Return the value of an attribute, `name`, of a type, or the substitutions in its text; None if it lacks."""
        value = self.value(name, data_type)
        return self.parser.parse_substitution(value) if isinstance(value, str) else value

    def needed(self, name: str) -> list[Substitution] | None:
        """Return the substitutions in an attribute, `name`. Raises an AttributeError if it is not there."""
        return None if name in self.ignored else self.parser.parse_substitution(self.entity.get_attr(name))

    def plain(self, name: str) -> str | None:
        """Return the text of an attribute, `name`, without its backslashes; None if it is not there."""
        value = self.value(name)
        return None if value is None else self.parser.escape_characters(value)

    def flag(self, name: str) -> bool | None:
        """Return the boolean of an attribute, `name`, which has no substitutions; None if it is not there."""
        value = self.value(name, bool)
        try:
            return None if value is None else bool(coerced(value, bool) if isinstance(value, str) else value)
        except LaunchError as error:
            raise LaunchError(f"'{name}': {error}") from None

    def words(self, name: str) -> list[list[Substitution]] | None:
        """Return the words of a command line in an attribute, `name`; None if it is not there."""
        text = self.value(name)
        try:
            return None if text is None else words_of(self.parser.parse_substitution(text))
        except LaunchError as error:
            raise LaunchError(f"'{name}': {error}") from None

    def inside(self, tag: str, read: Callable[[Reading], T]) -> list[T]:
        """Return the results of `read` for the elements called `tag`."""
        found = self.entity.get_attr(tag, data_type=List[Entity], optional=True)  # noqa: UP006
        return [self._read(each, read) for each in found or ()]

    def _read(self, entity: Entity, read: Callable[[Reading], T]) -> T:
        with placing(entity):
            found = read(Reading(entity, self.parser))
            entity.assert_entity_completely_parsed()
        return found

    def pairs(self, tag: str, name: str = "name", value: str = "value") -> list[tuple[Any, Any]]:
        """Return the elements called `tag`, such as `<env name= value=>`, as pairs of substitutions.

        Args:
            tag: Name of the elements.
            name: Attribute with the first of a pair.
            value: Attribute with the second.
        """
        return self.inside(tag, lambda each: (each.needed(name), each.needed(value)))

    def mapping(self, tag: str) -> Arguments | None:
        """Return the elements called `tag` as a mapping of substitutions; None if there is none."""
        found: dict[Any, Any] = {tuple(name): value for name, value in self.pairs(tag)}
        return found or None

    def actions(self, *left_out: str) -> list[Action]:
        """Return the actions in it, but for elements with the names `left_out`."""
        return [self.parser.parse_action(each) for each in self.entity.children if each.type_name not in left_out]


def arguments(cls: type, entity: Entity, parser: Parser, ignored: Collection[str]) -> Arguments:
    """Return the arguments for an object of an action's class.

    Args:
        cls: The class, which has a row in `ROWS` or a base that has one.
        entity: The element that stands for the action.
        parser: Parser of its texts, and of the elements in it.
        ignored: Attributes that are left to a subclass of the action.
    """
    reading = Reading(entity, parser, ignored)
    row = next((ROWS[each] for each in cls.__mro__ if each in ROWS), None)
    with placing(entity):
        found = {"condition": _condition(reading), **({} if row is None else row(reading))}
    return {name: each for name, each in found.items() if each is not None}


def _condition(reading: Reading) -> Condition | None:
    """Return the condition of an action, `if` or `unless`; None if it has none."""
    if_text, unless_text = reading.parsed("if"), reading.parsed("unless")
    if if_text is not None and unless_text is not None:
        raise LaunchError("it has 'if' and 'unless': one of them is enough")
    if if_text is not None:
        return IfCondition(if_text)
    return None if unless_text is None else UnlessCondition(unless_text)


def _parameter(reading: Reading) -> Any:
    file = reading.parsed("from")
    if file is not None:
        return ParameterFile(file, allow_substs=reading.parsed("allow_substs", bool) or False)
    nested = reading.inside("param", _parameter)
    name = tuple(reading.needed("name") or ())
    if not nested:
        return {name: _parameter_value(reading)}
    if not all(isinstance(each, dict) for each in nested):
        raise LaunchError("a file stands in no other parameter")
    return {name: {key: value for each in nested for key, value in each.items()}}


def _parameter_value(reading: Reading) -> ParameterValue:
    """Return the `value` of an element as that of a parameter; a text of no type is what the node reads."""
    identifier = reading.value("type")
    kind = None if identifier is None else get_data_type_from_identifier(identifier)
    value = reading.entity.get_attr("value", data_type=kind)
    if isinstance(value, str) and "$(" not in value and kind in (int, float, bool):
        value = coerced(value, kind)
    found = reading.parser.parse_if_substitutions(value)
    if kind is None:
        found = [as_node_reads(each) for each in found] if isinstance(value, list) else as_node_reads(found)
    return ParameterValue(found, value_type=kind)


def _process(reading: Reading, name: str = "name") -> Arguments:
    """Return the arguments of each process.

    Args:
        reading: Reader of the element.
        name: Attribute with the name for people.
    """
    return {
        "name": reading.parsed(name),
        "cwd": reading.parsed("cwd"),
        "prefix": reading.parsed("launch-prefix"),
        "output": reading.parsed("output"),
        "additional_env": reading.mapping("env") if "additional_env" not in reading.ignored else None,
        "respawn": reading.parsed("respawn", bool),
        "respawn_delay": _number(reading, "respawn_delay"),
        "respawn_max_retries": _retries(reading),
        "on_exit": _on_exit(reading),
        "sigterm_timeout": reading.parsed("sigterm_timeout", float),
        "sigkill_timeout": reading.parsed("sigkill_timeout", float),
        "emulate_tty": reading.flag("emulate_tty"),
    }


def _number(reading: Reading, name: str) -> Any:
    """Return the number of seconds, or the substitutions, in an attribute, `name`."""
    value = reading.parsed(name, float)
    if isinstance(value, float) and value < 0.0:
        raise LaunchError(f"'{name}' is a number of seconds from 0 on, got {value}")
    return value


def _retries(reading: Reading) -> int | None:
    value = reading.value("respawn_max_retries", int)
    if isinstance(value, str):
        raise LaunchError(f"'respawn_max_retries' is a number, got '{value:.40}'")
    return value if value is None else int(value)


def _on_exit(reading: Reading) -> list[Action] | None:
    """Return the end of the launch, for a process whose end is that of the launch."""
    said = reading.value("on_exit")
    if said not in (None, "shutdown"):
        raise LaunchError(f"'on_exit' is shutdown, got '{said:.40}'")
    return [actions.Shutdown(reason="it was required")] if said else None


def _executable(reading: Reading) -> Arguments:
    words = [*(reading.words("cmd") or ()), *(reading.words("args") or ())]
    if not words and "cmd" not in reading.ignored:
        reading.entity.get_attr("cmd")
        raise LaunchError("'cmd' is empty")
    return {"cmd": words or None, "shell": reading.flag("shell"), **_process(reading)}


def _node(reading: Reading) -> Arguments:
    shared = _process(reading, "exec_name")
    return {
        **shared,
        "exec_name": shared["name"],
        "package": reading.parsed("pkg"),
        "executable": reading.needed("exec"),
        "name": reading.parsed("name"),
        "namespace": reading.parsed("namespace"),
        "parameters": reading.inside("param", _parameter) if "param" not in reading.ignored else None,
        "remappings": _remappings(reading),
        "arguments": reading.words("args"),
        "ros_arguments": reading.words("ros_args"),
    }


def _remappings(reading: Reading) -> list[tuple[Any, Any]]:
    return reading.pairs("remap", "from", "to")


def _lifecycle_node(reading: Reading) -> Arguments:
    found = {**_node(reading), "autostart": reading.parsed("autostart", bool)}
    return {**found, "name": found["name"] or "", "namespace": found["namespace"] or ""}


def _container(reading: Reading) -> Arguments:
    reading.needed("name")
    return {**_node(reading), "composable_node_descriptions": reading.inside("composable_node", _composable)}


def _load(reading: Reading) -> Arguments:
    return {
        "target_container": reading.needed("target"),
        "composable_node_descriptions": reading.inside("composable_node", _composable),
    }


def _composable(reading: Reading) -> ComposableNode:
    made = ComposableNode(
        condition=_condition(reading),
        package=reading.needed("pkg") or "",
        plugin=reading.needed("plugin") or "",
        name=reading.parsed("name"),
        namespace=reading.parsed("namespace"),
        parameters=reading.inside("param", _parameter),
        remappings=_remappings(reading),
        extra_arguments=[{tuple(name): value} for name, value in reading.pairs("extra_arg")],
    )
    made.place = reading.entity.place
    return made


def _arg(reading: Reading) -> Arguments:
    reading.entity.get_attr("name")
    return {
        "name": reading.plain("name"),
        "default_value": reading.parsed("default"),
        "description": reading.plain("description"),
        "choices": reading.inside("choice", _choice) or None,
    }


def _choice(reading: Reading) -> str:
    return reading.parser.escape_characters(reading.entity.get_attr("value"))


def _include(reading: Reading) -> Arguments:
    given = [*reading.pairs("arg"), *reading.pairs("let")]
    return {"launch_description_source": reading.needed("file"), "launch_arguments": given}


def _group(reading: Reading) -> Arguments:
    return {
        "scoped": reading.flag("scoped"),
        "forwarding": reading.flag("forwarding"),
        "launch_configurations": reading.mapping("keep"),
        "actions": reading.actions("keep"),
    }


def _bool_arg(reading: Reading) -> Arguments:
    reading.entity.get_attr("name")
    described = reading.plain("description")
    return {"name": reading.plain("name"), "default_value": reading.parsed("default"), "description": described}


def _for_each(reading: Reading) -> Arguments:
    """Read a loop; its actions are read again for each iteration, which starts processes of its own."""
    reading.actions()
    return {
        "input_values": reading.needed("values"),
        "function": lambda **values: [actions.Iteration(reading.actions(), values)],
    }


def _for_loop(reading: Reading) -> Arguments:
    reading.actions()
    name = reading.entity.get_attr("name")
    return {
        "length": reading.needed("len"),
        "name": name,
        "function": lambda index: [actions.Iteration(reading.actions(), {name: index})],
    }


def _timer(reading: Reading) -> Arguments:
    period = reading.parsed("period", float)
    if period is None:
        reading.entity.get_attr("period")
    cancels = reading.parsed("cancel_on_shutdown", bool)
    return {"period": period, "cancel_on_shutdown": cancels, "actions": reading.actions()}


def _shutdown(reading: Reading) -> Arguments:
    return {"reason": reading.value("reason")}


def _append_env(reading: Reading) -> Arguments:
    prepend, separator = reading.parsed("prepend", bool), reading.parsed("separator")
    return {**_named(reading, name="name", value="value"), "prepend": prepend, "separator": separator}


def _set_use_sim_time(reading: Reading) -> Arguments:
    """Read it as in Python: there ROS 2 hands a list of substitutions to rclpy, which refuses it."""
    value = reading.entity.get_attr("value", data_type=bool)
    return {"value": value is True or value == "true"}


def _named(reading: Reading, **names: str) -> Arguments:
    """Return the substitutions in attributes, which all must be there, by the names of arguments."""
    return {argument: reading.needed(name) for argument, name in names.items()}


ROWS: dict[type, Callable[[Reading], Arguments]] = {
    actions.AppendEnvironmentVariable: _append_env,
    actions.DeclareBooleanLaunchArgument: _bool_arg,
    actions.DeclareLaunchArgument: _arg,
    actions.ExecuteProcess: _executable,
    actions.ForEach: _for_each,
    actions.ForLoop: _for_loop,
    actions.GroupAction: _group,
    actions.IncludeLaunchDescription: _include,
    actions.Log: functools.partial(_named, msg="message", level="level"),
    actions.LogInfo: functools.partial(_named, msg="message"),
    actions.ResetLaunchConfigurations: lambda reading: {"launch_configurations": reading.mapping("keep")},
    actions.SetEnvironmentVariable: functools.partial(_named, name="name", value="value"),
    actions.SetLaunchConfiguration: functools.partial(_named, name="name", value="value"),
    actions.Shutdown: _shutdown,
    actions.TimerAction: _timer,
    actions.UnsetEnvironmentVariable: functools.partial(_named, name="name"),
    actions.UnsetLaunchConfiguration: functools.partial(_named, name="name"),
    ros.ComposableNodeContainer: _container,
    ros.LifecycleNode: _lifecycle_node,
    ros.LoadComposableNodes: _load,
    ros.Node: _node,
    ros.PushROSNamespace: functools.partial(_named, namespace="namespace"),
    ros.SetParameter: functools.partial(_named, name="name", value="value"),
    ros.SetParametersFromFile: functools.partial(_named, filename="filename"),
    ros.SetROSLogDir: functools.partial(_named, new_log_dir="new_log_dir"),
    ros.SetRemap: functools.partial(_named, src="from", dst="to"),
    ros.SetUseSimTime: _set_use_sim_time,
}
"""Functions that read the arguments of an action, by its class."""
TAGS: dict[str, type[Action]] = {
    "append_env": actions.AppendEnvironmentVariable,
    "arg": actions.DeclareLaunchArgument,
    "bool_arg": actions.DeclareBooleanLaunchArgument,
    "executable": actions.ExecuteProcess,
    "for": actions.ForLoop,
    "for_each": actions.ForEach,
    "group": actions.GroupAction,
    "include": actions.IncludeLaunchDescription,
    "let": actions.SetLaunchConfiguration,
    "lifecycle_node": ros.LifecycleNode,
    "load_composable_node": ros.LoadComposableNodes,
    "load_composable_nodes": ros.LoadComposableNodes,
    "log_debug": actions.LogDebug,
    "log_error": actions.LogError,
    "log_info": actions.LogInfo,
    "log_warning": actions.LogWarning,
    "node": ros.Node,
    "node_container": ros.ComposableNodeContainer,
    "pop_env": actions.PopEnvironment,
    "push_env": actions.PushEnvironment,
    "push_ros_namespace": ros.PushROSNamespace,
    "reset": actions.ResetLaunchConfigurations,
    "reset_env": actions.ResetEnvironment,
    "ros_timer": ros.ROSTimer,
    "set_env": actions.SetEnvironmentVariable,
    "set_launch_configuration": actions.SetLaunchConfiguration,
    "set_parameter": ros.SetParameter,
    "set_parameters_from_file": ros.SetParametersFromFile,
    "set_remap": ros.SetRemap,
    "set_ros_log_dir": ros.SetROSLogDir,
    "set_use_sim_time": ros.SetUseSimTime,
    "shutdown": actions.Shutdown,
    "timer": actions.TimerAction,
    "unset_env": actions.UnsetEnvironmentVariable,
    "unset_launch_configuration": actions.UnsetLaunchConfiguration,
}
"""Classes by tag, in the spelling with `_`."""


def methods() -> dict[str, Method]:
    """Return the functions of an element and the parser, by the element's name."""
    return {**{tag: cls.parse for tag, cls in TAGS.items()}, "log": _log}


def _log(entity: Entity, parser: Parser) -> tuple[type[Action], Arguments]:
    """Read a line; without a level it is of the level info, as before 2025."""
    has_level = entity.get_attr("level", optional=True) is not None
    return actions.Log.parse(entity, parser) if has_level else actions.LogInfo.parse(entity, parser)
