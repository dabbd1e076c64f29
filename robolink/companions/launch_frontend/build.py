"""Builder of launch descriptions from elements: each tag of XML and YAML launch files becomes its action."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any, TypeAlias

from robolink.companions.launch import actions
from robolink.companions.launch.bases import Action, LaunchDescriptionEntity, LaunchError, Substitution
from robolink.companions.launch.launch_description import LaunchDescription
from robolink.companions.launch.typed_values import truth_of
from robolink.companions.launch_frontend.entity import Entity
from robolink.companions.launch_frontend.nodes import NODES
from robolink.companions.launch_frontend.processes import PROCESS, executable, pairs
from robolink.companions.launch_frontend.xml_reader import read_xml
from robolink.companions.launch_frontend.yaml_reader import read_yaml
from robolink.companions.launch_ros import actions as ros
from robolink.exceptions import nearest
from robolink.system.terminal import shown

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
    kept = pairs(entity, "keep", "name", "value")
    return actions.GroupAction(
        built(inside),
        scoped=_flag(entity, "scoped"),
        forwarding=_flag(entity, "forwarding"),
        launch_configurations=kept or None,
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
