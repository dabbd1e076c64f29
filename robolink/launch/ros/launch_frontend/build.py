"""Parser of XML and YAML launch files: a table with a function for each kind of element, which makes its action."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any, TypeAlias

import yaml

from robolink.exceptions import nearest
from robolink.launch.ros.launch import actions
from robolink.launch.ros.launch.actions import Shutdown
from robolink.launch.ros.launch.bases import Action, LaunchDescriptionEntity, LaunchError, Substitution
from robolink.launch.ros.launch.sources import LaunchDescription
from robolink.launch.ros.launch.utilities import TextSubstitution, as_node_reads, checked, coerced, item_type, truth_of
from robolink.launch.ros.launch_frontend.elements import Entity, read_xml, read_yaml
from robolink.launch.ros.launch_ros import actions as ros
from robolink.launch.ros.launch_ros.descriptions import ComposableNode, ParameterFile, ParameterValue
from robolink.system.terminal import shown

TYPES: dict[str, Any] = {
    "str": str,
    "int": int,
    "float": float,
    "bool": bool,
    "list_of_str": list[str],
    "list_of_int": list[int],
    "list_of_float": list[float],
    "list_of_bool": list[bool],
    "yaml": None,
}
"""Types that an attribute `type` may name."""
OTHER_TYPES = {"double": "float", "string": "str", "integer": "int", "boolean": "bool"}


def parameters_in(entity: Entity) -> list[Any]:
    """Return the parameters of an action for the `param` elements of a node, `entity`."""
    return [_parameter(each) for each in entity.inside("param")]


def value_of(entity: Entity) -> ParameterValue:
    """Return the `value` of an element, `entity`, as that of a parameter. Raises DocumentError."""
    if "value" not in entity.attributes:
        raise entity.error("'value' is missing")
    kind = _kind(entity)
    try:
        value = _typed(entity, kind) if entity.is_typed else _coerced(entity, kind)
    except LaunchError as error:
        raise entity.error(str(error)) from None
    found = [_plain(entity, each, kind) for each in value] if isinstance(value, list) else _plain(entity, value, kind)
    return ParameterValue(found, value_type=kind)


def _kind(entity: Entity) -> Any:
    """Return the type that `type` names; None leaves it to YAML."""
    name = entity.texts("type")
    if name is not None and name not in TYPES:
        hint = nearest(name, TYPES) or f": {OTHER_TYPES[name]}" if name in OTHER_TYPES else f": {', '.join(TYPES)}"
        raise entity.error(f"no type is called '{shown(name)}'{hint}")
    return TYPES[name or "yaml"]


def _typed(entity: Entity, kind: Any) -> Any:
    """Return a value of YAML, which has its type; texts may hold substitutions. Raises LaunchError for another type."""
    value = entity.attributes["value"]
    texts = [each for each in value if not isinstance(each, str)] if isinstance(value, list) else value
    if isinstance(value, str) or texts == []:
        return value
    checked(texts, value)
    inner = item_type(kind)
    expected = kind if inner is None else list
    if kind is not None and not isinstance(value, expected):
        raise LaunchError(f"'value' is of type {entity.texts('type')}, got {value!r:.40}")
    if inner is not None and not all(isinstance(each, inner) for each in texts):
        raise LaunchError(f"'value' is a {entity.texts('type')}, got {value!r:.40}")
    return value


def _coerced(entity: Entity, kind: Any) -> Any:
    """Return a value of XML as its type has it; texts stay what they are if they do not spell one."""
    text = str(entity.attributes["value"])
    separator = entity.texts("value-sep")
    if separator:
        inner = item_type(kind)
        if kind is not None and inner is None:
            raise LaunchError(f"'value' is of type {entity.texts('type')}, and 'value-sep' makes a list")
        return [_read(each, inner) for each in text.split(separator)]
    if "$(" in text and item_type(kind) is None and kind is not None:
        return text
    return _read(text, kind)


def _read(text: str, kind: Any) -> Any:
    """Return `text` as YAML reads it; a list may hold texts with substitutions. Raises LaunchError."""
    if kind is not None and item_type(kind) is None:
        return coerced(text, kind)
    try:
        value = yaml.safe_load(text) if text else text
    except (yaml.YAMLError, ValueError, RecursionError):
        return text
    inner = item_type(kind)
    if inner is not None and not isinstance(value, list):
        raise LaunchError(f"expected a list of {inner.__name__}, got '{shown(text)}'")
    if not isinstance(value, list):
        return checked(value, text)
    plain = [each for each in value if not isinstance(each, str)]
    checked(plain if plain else value, text)
    if inner is not None and not all(isinstance(each, (str, inner)) for each in value):
        raise LaunchError(
            f"expected a list of {inner.__name__}, got '{shown(text)}'"
            + (": write 1.0 for 1" if inner is float else "")
        )
    return value


def _parameter(entity: Entity) -> Any:
    if "from" in entity.attributes:
        entity.check(("from", "allow_substs"))
        return ParameterFile(entity.needed("from"), allow_substs=entity.optional("allow_substs", bool) or False)
    name = tuple(entity.needed("name"))
    if entity.children:
        entity.check(("name",), ("param",))
        return {name: _merged(entity)}
    entity.check(("name", "value", "type") if entity.is_typed else ("name", "value", "value-sep", "type"))
    return {name: value_of(entity)}


def _merged(entity: Entity) -> dict[Any, Any]:
    merged: dict[Any, Any] = {}
    for each in entity.inside("param"):
        inner = _parameter(each)
        if not isinstance(inner, dict):
            raise each.error("a file stands in no other parameter")
        merged.update(inner)
    return merged


def _parsed(entity: Entity, value: Any) -> Any:
    """Return a text with its substitutions, a text without any as it is, and any other value."""
    if not isinstance(value, str) or not value:
        return value
    parts = entity.parsed(value)
    return parts[0].text if len(parts) == 1 and isinstance(parts[0], TextSubstitution) else parts


def _plain(entity: Entity, value: Any, kind: Any) -> Any:
    """Return a value with its substitutions; a text of no type is what the node reads."""
    found = _parsed(entity, value)
    return as_node_reads(found) if kind is None else found


PROCESS = (
    "cwd",
    "name",
    "launch-prefix",
    "output",
    "respawn",
    "respawn_delay",
    "respawn_max_retries",
    "on_exit",
    "sigterm_timeout",
    "sigkill_timeout",
    "emulate_tty",
)
"""Attributes of each process."""


def executable(entity: Entity, name: str = "name") -> dict[str, Any]:
    """Return the arguments of ExecuteProcess that the attributes of an element stand for. Raises DocumentError.

    Args:
        entity: The element.
        name: Attribute with the name for people.
    """
    prefix = entity.optional("launch-prefix")
    found: dict[str, Any] = {
        "name": entity.optional(name),
        "cwd": entity.optional("cwd"),
        "prefix": prefix,
        "additional_env": pairs(entity, "env", "name", "value") or None,
        "respawn": entity.optional("respawn", bool) or False,
        "respawn_delay": entity.optional("respawn_delay", float),
        "respawn_max_retries": _retries(entity),
        "on_exit": _on_exit(entity),
    }
    return {key: value for key, value in found.items() if value is not None}


def pairs(entity: Entity, tag: str, name: str, value: str) -> dict[Any, Any]:
    """Return the children with a tag, such as `<env name= value=>`, as a mapping of substitutions.

    Args:
        entity: The element.
        tag: Tag of the children.
        name: Attribute of the key.
        value: Attribute of the value.
    """
    found = {}
    for each in entity.inside(tag):
        each.check((name, value))
        found[tuple(each.needed(name))] = each.needed(value)
    return found


def _retries(entity: Entity) -> int:
    text = entity.texts("respawn_max_retries", int)
    try:
        return -1 if text is None else int(text)
    except ValueError:
        raise entity.error(f"'respawn_max_retries' is a number, got '{text:.40}'") from None


def _on_exit(entity: Entity) -> Shutdown | None:
    """Return the end of the launch, for a process whose end is that of the launch."""
    said = entity.texts("on_exit")
    if said not in (None, "shutdown"):
        raise entity.error(f"'on_exit' is shutdown, got '{said:.40}'")
    return Shutdown(reason="it was required") if said else None


NODE = ("pkg", "exec", "name", "namespace", "exec_name", "args", "ros_args", *PROCESS)
"""Attributes of a node."""
INSIDE = ("param", "remap", "env")
"""Elements inside of a node."""


def _settings(entity: Entity) -> dict[str, Any]:
    """Return the arguments of Node that an element stands for, without its name and namespace."""
    shared = executable(entity, "exec_name")
    shared["exec_name"] = shared.pop("name", None)
    return {
        "package": entity.needed("pkg"),
        "executable": entity.needed("exec"),
        "parameters": parameters_in(entity),
        "remappings": _remappings(entity),
        "arguments": entity.words("args"),
        "ros_arguments": entity.words("ros_args"),
        **shared,
    }


def _remappings(entity: Entity) -> list[tuple[list[Substitution], list[Substitution]]]:
    for each in entity.inside("remap"):
        each.check(("from", "to"))
    return [(each.needed("from"), each.needed("to")) for each in entity.inside("remap")]


def _named(entity: Entity) -> dict[str, Any]:
    return {"name": entity.optional("name"), "namespace": entity.optional("namespace")}


def _node(entity: Entity) -> Action:
    entity.check(NODE, INSIDE)
    return ros.Node(**_named(entity), **_settings(entity))


def _lifecycle_node(entity: Entity) -> Action:
    entity.check((*NODE, "autostart"), INSIDE)
    named = {name: value or "" for name, value in _named(entity).items()}
    return ros.LifecycleNode(**named, autostart=entity.optional("autostart", bool) or False, **_settings(entity))


def _container(entity: Entity) -> Action:
    entity.check(NODE, (*INSIDE, "composable_node"))
    named = {**_named(entity), "name": entity.needed("name")}
    return ros.ComposableNodeContainer(**named, **_settings(entity), composable_node_descriptions=_composed(entity))


def _load(entity: Entity) -> Action:
    entity.check(("target",), ("composable_node",))
    return ros.LoadComposableNodes(
        target_container=entity.needed("target"), composable_node_descriptions=_composed(entity)
    )


def _composed(entity: Entity) -> list[ComposableNode]:
    return [_composable(each) for each in entity.inside("composable_node")]


def _composable(entity: Entity) -> ComposableNode:
    condition = entity.condition()
    entity.check(("pkg", "plugin", "name", "namespace"), ("param", "remap", "extra_arg"))
    for each in entity.inside("extra_arg"):
        each.check(("name", "value"))
    made = ComposableNode(
        package=entity.needed("pkg"),
        plugin=entity.needed("plugin"),
        parameters=parameters_in(entity),
        remappings=_remappings(entity),
        extra_arguments=[{tuple(each.needed("name")): each.needed("value")} for each in entity.inside("extra_arg")],
        condition=condition,
        **_named(entity),
    )
    made.place = entity.place
    return made


NODES: dict[str, Callable[[Entity], Action]] = {
    "lifecycle_node": _lifecycle_node,
    "load_composable_node": _load,
    "load_composable_nodes": _load,
    "node": _node,
    "node_container": _container,
}
"""Builders by tag."""


Build: TypeAlias = "Callable[[Entity], Action]"


def parse(path: Path) -> LaunchDescription:
    """Return the description in an XML or YAML file, `path`. Raises DocumentError with its line."""
    top = read_yaml(path) if path.suffix in (".yaml", ".yml") else read_xml(path)
    ignored = [each for each in top.attributes if each not in ("version", "deprecated")]
    notes = [
        f"{path.name}:{top.place.line}: launch has no attribute '{shown(each)}': it is ignored" for each in ignored
    ]
    said = [actions.LogInfo(msg=each) for each in notes]
    return LaunchDescription([*said, *built(top.children)], deprecated_reason=top.texts("deprecated"))


def built(entities: Iterable[Entity]) -> list[LaunchDescriptionEntity]:
    """Return the actions that `entities` stand for. Raises DocumentError with the line of the first wrong one."""
    return [_action(each) for each in entities]


def _action(entity: Entity) -> Action:
    builders = {**BUILDERS, **NODES}
    if entity.name not in builders:
        raise entity.error(f"there is no such element{nearest(entity.name, builders)}")
    condition = entity.condition()
    action = builders[entity.name](entity)
    action.place = entity.place
    if condition is not None:
        action._condition = condition
    return action


def _arg(entity: Entity) -> Action:
    entity.check(("name", "default", "description"), ("choice",))
    for each in entity.inside("choice"):
        each.check(("value",))
    choices = [each.plain("value") for each in entity.inside("choice")]
    return actions.DeclareLaunchArgument(
        entity.plain("name"),
        default_value=entity.optional("default"),
        description=entity.plain("description") if "description" in entity.attributes else None,
        choices=choices or None,
    )


def _let(entity: Entity) -> Action:
    entity.check(("name", "value"))
    return actions.SetLaunchConfiguration(entity.needed("name"), entity.needed("value"))


def _include(entity: Entity) -> Action:
    entity.check(("file",), ("arg", "let"))
    for each in entity.children:
        each.check(("name", "value"))
    arguments = [(each.needed("name"), each.needed("value")) for each in entity.children]
    return actions.IncludeLaunchDescription(entity.needed("file"), launch_arguments=arguments)


def _group(entity: Entity) -> Action:
    _only_attributes(entity, ("scoped", "forwarding"))
    inside = [each for each in entity.children if each.name != "keep"]
    retained = pairs(entity, "keep", "name", "value")
    return actions.GroupAction(
        built(inside),
        scoped=_flag(entity, "scoped"),
        forwarding=_flag(entity, "forwarding"),
        launch_configurations=retained or None,
    )


def _reset(entity: Entity) -> Action:
    entity.check((), ("keep",))
    return actions.ResetLaunchConfigurations(pairs(entity, "keep", "name", "value"))


def _timer(entity: Entity) -> Action:
    _only_attributes(entity, ("period", "cancel_on_shutdown"))
    return actions.TimerAction(period=entity.needed("period", float), actions=built(entity.children))


def _log(entity: Entity) -> Action:
    entity.check(("message", "level"))
    return actions.LogInfo(msg=entity.needed("message"))


def _shutdown(entity: Entity) -> Action:
    entity.check(("reason",))
    return actions.Shutdown(reason=entity.texts("reason") or "reason not given")


def _append_env(entity: Entity) -> Action:
    entity.check(("name", "value", "prepend", "separator"))
    more: dict[str, Any] = {
        each: entity.optional(each, *kinds)
        for each, kinds in (("prepend", [bool]), ("separator", []))
        if each in entity.attributes
    }
    return actions.AppendEnvironmentVariable(entity.needed("name"), entity.needed("value"), **more)


def _with(make: Callable[..., Action], *names: str) -> Build:
    """Return the builder of an action whose arguments are these attributes, in their order."""

    def build(entity: Entity) -> Action:
        entity.check(names)
        return make(*(entity.needed(name) for name in names))

    return build


def _set_use_sim_time(entity: Entity) -> Action:
    """Build it as in Python: there ROS 2 hands a list of substitutions to rclpy, which refuses it."""
    entity.check(("value",))
    text = entity.texts("value", bool)
    return ros.SetUseSimTime(text == "true")


def _push_namespace(entity: Entity) -> Action:
    entity.check(("namespace",))
    return ros.PushROSNamespace(entity.needed("namespace"))


def _executable(entity: Entity) -> Action:
    entity.check(("cmd", "args", "shell", *PROCESS), ("env",))
    cmd: list[list[Substitution]] = [*entity.words("cmd"), *entity.words("args")]
    if not cmd:
        raise entity.error("'cmd' is missing")
    return actions.ExecuteProcess(cmd=cmd, shell=_flag(entity, "shell", False), **executable(entity))


def _flag(entity: Entity, name: str, default: bool = True) -> bool:
    text = entity.texts(name, bool)
    try:
        return default if text is None else truth_of(text)
    except LaunchError as error:
        raise entity.error(f"'{name}': {error}") from None


def _only_attributes(entity: Entity, names: tuple[str, ...]) -> None:
    """Check the attributes of an element that holds actions of any kind."""
    Entity(entity.tag, entity.place, entity.attributes).check(names)


BUILDERS: dict[str, Build] = {
    "append_env": _append_env,
    "arg": _arg,
    "executable": _executable,
    "group": _group,
    "include": _include,
    "let": _let,
    "log": _log,
    "log_info": _log,
    "pop_env": _with(actions.PopEnvironment),
    "push_env": _with(actions.PushEnvironment),
    "push_ros_namespace": _push_namespace,
    "reset": _reset,
    "reset_env": _with(actions.ResetEnvironment),
    "ros_timer": _timer,
    "set_env": _with(actions.SetEnvironmentVariable, "name", "value"),
    "set_launch_configuration": _let,
    "set_parameter": _with(ros.SetParameter, "name", "value"),
    "set_parameters_from_file": _with(ros.SetParametersFromFile, "filename"),
    "set_remap": _with(ros.SetRemap, "from", "to"),
    "set_ros_log_dir": _with(ros.SetROSLogDir, "new_log_dir"),
    "set_use_sim_time": _set_use_sim_time,
    "shutdown": _shutdown,
    "timer": _timer,
    "unset_env": _with(actions.UnsetEnvironmentVariable, "name"),
    "unset_launch_configuration": _with(actions.UnsetLaunchConfiguration, "name"),
}
"""Builders by tag, in the spelling with `_`; those of nodes are beside them."""
