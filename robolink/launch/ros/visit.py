"""Visit of a launch description: executes its actions in their order and collects the processes that they start."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from robolink.companions.ament_index import package_not_here
from robolink.exceptions import DocumentError, nearest
from robolink.launch.entry import MOST_PROCESSES, ArgumentHelp, Entry
from robolink.launch.lookup import home_of
from robolink.launch.ros.entries import EntryMaker, components, container_of, ends_launch, placed, target_of
from robolink.launch.ros.launch.actions import (
    DeclareLaunchArgument,
    EmitEvent,
    ExecuteLocal,
    IncludeLaunchDescription,
    Log,
    OpaqueCoroutine,
    OpaqueFunction,
    SetLaunchConfiguration,
    TimerAction,
)
from robolink.launch.ros.launch.bases import (
    SCOPED,
    Action,
    BaseEventHandler,
    LaunchContext,
    LaunchDescriptionEntity,
    LaunchError,
    Place,
    entities_in,
)
from robolink.launch.ros.launch.event_handlers import OnProcessExit, OnShutdown
from robolink.launch.ros.launch.sources import (
    FILES,
    AnyLaunchDescriptionSource,
    Described,
    LaunchDescriptionSource,
    LaunchFileNotFoundError,
    described,
)
from robolink.launch.ros.launch.utilities import perform_substitutions, performed
from robolink.launch.ros.launch_ros.actions import ComposableNodeContainer, LifecycleNode, LoadComposableNodes
from robolink.launch.ros.launch_ros.descriptions import ComposableNode, old_names_note
from robolink.launch.ros.programs import include_absent
from robolink.launch.ros.surroundings import (
    Absent,
    AbsentError,
    absent_package,
    as_document_error,
    reason_of,
    surroundings,
)
from robolink.system.terminal import shown
from robolink.workspace import Folder

if TYPE_CHECKING:
    import asyncio

    from robolink.launch.ros.launch.sources import LaunchDescription


MOST_VISITED = 100_000
"""Most entities of a launch; a function that returns itself would never end."""


T = TypeVar("T")
_ACTING = (EmitEvent, Log, OpaqueCoroutine, OpaqueFunction)
"""Actions that are for the moment itself: these are not foreseen."""


@dataclass
class Started:
    """A process of the launch: the action that starts it, and its entry."""

    action: ExecuteLocal
    entry: Entry

    @property
    def process(self) -> str:
        """Name of the process in which it runs."""
        return self.entry.node.process or self.entry.name


@dataclass
class Visit:
    """State of a launch while it is visited: its context, and what its actions ask for.

    Args:
        context: Values of the launch.
        maker: Makes the entries.
        top: The launch file itself, for errors that have no better place.
    """

    context: LaunchContext
    maker: EntryMaker
    top: Path
    started: list[Started] = field(default_factory=list)
    """Processes that are to start, since the last look."""
    timers: list[tuple[TimerAction, dict[str, Any]]] = field(default_factory=list)
    """Timers that begin, since the last look, each with the values around it."""
    absent: list[ExecuteLocal] = field(default_factory=list)
    """Processes that are left out, since the last look."""
    first: LaunchDescriptionEntity | None = None
    """The launch file itself as an entity: without it nothing is left."""
    visited: int = 0
    """Number of the actions that were visited at this moment."""
    futures: list[tuple[LaunchDescriptionEntity, asyncio.Future[Any]]] = field(default_factory=list)
    """Entities for which a LaunchService waits, each with the future of its end."""
    _containers: dict[str, ComposableNodeContainer] = field(default_factory=dict)
    _processes: dict[str, str] = field(default_factory=dict)
    _followed: set[int] = field(default_factory=set)
    _old_names: set[tuple[str, tuple[str, ...]]] = field(default_factory=set)

    @property
    def goes_on(self) -> bool:
        """True if timers, handlers or events are left: more may happen while the processes run."""
        is_alive = any(isinstance(each.action, LifecycleNode) for each in self.started)
        return bool(self.timers or self.context.handlers or self.context.emitted or is_alive)

    def run(self, entities: Iterable[LaunchDescriptionEntity]) -> None:
        """Visit entities and all that they bring along, depth first. Raises DocumentError with the user's line."""
        waiting: list[LaunchDescriptionEntity] = list(entities)[::-1]
        while waiting:
            each = waiting.pop()
            self.visited += 1
            with self.placing(each):
                if self.visited > MOST_VISITED:
                    raise self._error(each, f"it never ends: more than {MOST_VISITED:,} actions were visited")
                inside = self._visit(each)
            waiting.extend(inside[::-1])

    def foresee(self) -> None:
        """Visit what timers and handlers will bring as far as that is known, as if it came now; lines are not said."""
        seen = {id(each.action) for each in self.started}
        while True:
            timers, self.timers = self.timers, []
            waiting = [(timer.actions, around) for timer, around in timers]
            found = [each for each in self.context.handlers if not isinstance(each, OnShutdown)]
            handlers = [each for each in found if id(each) not in seen]
            seen.update(map(id, handlers))
            waiting += [(self.following(each), each.around) for each in handlers]
            if not waiting:
                return
            for entities, around in waiting:
                new = [each for each in entities if id(each) not in seen and not isinstance(each, _ACTING)]
                seen.update(map(id, new))
                self.run_within(new, around)

    def following(self, handler: BaseEventHandler) -> list[LaunchDescriptionEntity]:
        """Return the entities that follow an event, as far as its handler knows them before."""
        with self.placing(handler):
            return list(handler.describe()[1])

    def run_within(self, entities: Iterable[LaunchDescriptionEntity], around: Mapping[str, Mapping[str, Any]]) -> None:
        """Visit entities with the values around them at an earlier time, where these are not set now."""
        self.within(around, lambda: self.run(entities))

    def within(self, around: Mapping[str, Mapping[str, Any]], act: Callable[[], T]) -> T:
        """Return the result of `act()`, called with such values."""
        context = self.context
        context.extend_locals({name: each for name, each in around["locals"].items() if name != "event"})
        changed: list[tuple[dict[str, Any], str]] = []
        for which in SCOPED:
            values = getattr(context, which)
            for name in [each for each in around[which] if each not in values]:
                values[name] = around[which][name]
                changed.append((values, name))
        try:
            return act()
        finally:
            for values, name in changed:
                values.pop(name, None)

    def _visit(self, entity: LaunchDescriptionEntity) -> list[LaunchDescriptionEntity]:
        try:
            inside = entities_in(entity.visit(self.context))
            self.take()
        except LaunchFileNotFoundError as error:
            package = package_not_here(str(error.path))
            if not package or not isinstance(entity, IncludeLaunchDescription):
                raise
            self.say_at(entity, f"left out: {error.path.name}, since {include_absent(package)}")
            return []
        except DocumentError:
            raise
        except AbsentError as error:
            if entity is self.first:
                raise
            return self._leave_out(entity, error)
        except Exception as error:
            if not absent_package(error) or entity is self.first:
                raise
            self.say_at(entity, f"left out: {reason_of(error)}")
            return []
        self.check(entity, inside)
        self._note_file()
        if self.context.asyncio_loop is not None and (future := entity.get_asyncio_future()) is not None:
            self.futures.append((entity, future))
        return inside

    def take(self) -> None:
        """Take over what was executed since the last look."""
        executed, self.context.executed = self.context.executed, []
        for action in executed:
            self._take(action)

    def _leave_out(self, entity: LaunchDescriptionEntity, error: AbsentError) -> list[LaunchDescriptionEntity]:
        """Leave out, with a line, what cannot be carried out without a Python module; it brings nothing along."""
        self.context.executed.clear()
        self.say_at(entity, f"left out: {error}")
        if isinstance(entity, ExecuteLocal):
            self.absent.append(entity)
        elif isinstance(entity, (DeclareLaunchArgument, SetLaunchConfiguration)):
            self.context.launch_configurations[performed(self.context, entity.name)] = Absent(error.module)
        return []

    def check(self, entity: object, inside: Iterable[object]) -> None:
        """Raise DocumentError, at the line of `entity`, unless all that it brings along can be visited."""
        for each in inside:
            if not isinstance(each, LaunchDescriptionEntity):
                raise self._error(entity, f"an action is expected, got {type(each).__name__}")

    def _take(self, action: Action) -> None:
        """Take over an action whose effect is beyond the context."""
        self._note_old_names(action)
        if isinstance(action, ComposableNodeContainer):
            name = container_of(action, self.context)
            self._containers[name] = action
            self._load(action.composable_node_descriptions, name, action)
        elif isinstance(action, LoadComposableNodes):
            target = target_of(action, self.context)
            if self.context.asyncio_loop is None or target in self._containers:
                self._load(action.composable_node_descriptions, target, action)
            else:  # a program's LaunchService meets containers of others
                action.ask(self.context, f"/{target}")
        elif isinstance(action, ExecuteLocal):
            self._start(action)
        elif isinstance(action, TimerAction):
            self.timers.append((action, self.context.snapshot()))

    def _load(self, described: Sequence[ComposableNode], container: str, action: Action) -> None:
        """Start components in the process of their container, or in one of their own if that runs already."""
        of_container = self._containers.get(container)
        if of_container is None:
            of_container = ComposableNodeContainer(
                name=container, package="rclcpp_components", executable="component_container"
            )
            of_container.place = action.place
        for each in described:
            self._note_old_names(each)
        process = self._processes.get(container, "")
        if not any(each.process == process for each in self.started):  # it runs already, or was not there yet
            process = self._processes[container] = self.maker.free(container)
        entries = list(components(self.maker, described, of_container, process, self.context))
        self._follow(of_container)
        self.started += [Started(of_container, each) for each in entries]
        if not entries and isinstance(action, ComposableNodeContainer):
            self.absent.append(action)

    def _note_old_names(self, entity: object) -> None:
        """Note for people, once for each file, that an entity was given arguments by old names."""
        names: tuple[str, ...] = getattr(entity, "old_names", ())
        key = (self.place_of(entity).file, names)
        if names and key not in self._old_names:
            self._old_names.add(key)
            self.say_at(entity, old_names_note(names))

    def _start(self, action: ExecuteLocal) -> None:
        entry = self.maker.make(action, self.context)
        if entry is None:
            self.absent.append(action)
            return
        self._follow(action)
        self.started.append(Started(action, entry))
        if len(self.started) > MOST_PROCESSES:
            raise self._error(action, f"more than {MOST_PROCESSES:,} processes")

    def _follow(self, action: ExecuteLocal) -> None:
        """Register what follows the end of a process, unless it is the end of the launch, which a rule decides.

        A LaunchService has no such rules: there the end of the launch is an event like others.
        """
        is_rule = self.context.asyncio_loop is None and ends_launch(action.on_exit)
        if action.on_exit is not None and not is_rule and id(action) not in self._followed:
            self._followed.add(id(action))
            self.context.register_event_handler(OnProcessExit(target_action=action, on_exit=action.on_exit))

    def _note_file(self) -> None:
        """Note the launch file that is being visited: it is one of those that `--watch` watches."""
        path = self.context.get_locals_as_dict().get("current_launch_file_path")
        if path is not None and Path(path) not in self.maker.files:
            self.maker.files |= {Path(path)}

    @contextmanager
    def placing(self, entity: object) -> Iterator[None]:
        """Turn any error of the block into a DocumentError at the line of the user's file that made `entity`.

        A KeyboardInterrupt passes, since a Ctrl-C raises it; one of its subclasses is the file's own.
        """
        try:
            yield
        except BaseException as error:
            if type(error) is KeyboardInterrupt:
                raise
            raise as_document_error(error, self.place_of(entity)) from None

    def place_of(self, entity: object) -> Place:
        """Return the place of the user's file at which an entity was made; the file as a whole if it is unknown."""
        place: Place = getattr(entity, "place", Place())
        return place if place.file else Place(str(self.context.get_locals_as_dict().get(_PATH, self.top)))

    def say_at(self, entity: object, text: str) -> None:
        """Add a line for people about an entity."""
        self.context.said.append(f"{placed(self.place_of(entity))}{text}")

    def _error(self, entity: object, message: str) -> DocumentError:
        place = self.place_of(entity)
        return DocumentError(message, place.file, place.line)


_PATH = "current_launch_file_path"


def visited(
    path: Path, given: Mapping[str, str], workspace: Folder, description: LaunchDescription | None = None
) -> Visit:
    """Return the visit of a launch file, up to the point at which only time and events go on.

    Args:
        path: The launch file.
        given: Launch arguments by name, as people type them.
        workspace: Folder in which the packages of a file outside of all workspaces are looked up.
        description: Description that the file has made already; None reads it from the file.

    Raises:
        DocumentError: for a mistake, with the file and line of the user's code.
        NotFoundError: for a `workspace` that is not a folder.
    """
    path = path.absolute()
    home = home_of(path, workspace)
    with surroundings(home) as absences:
        context = LaunchContext(argv=[f"{name}:={value}" for name, value in given.items()])
        context.environment = dict(os.environ)
        absences.say = context.said.append
        context.launch_configurations.update(given)
        visit = Visit(context, EntryMaker(home, context.said.append), path)
        visit.first = _included(path, description)
        visit.run([visit.first])
    if description is None:  # else whoever made it may read them
        _note_unread(context, given)
    return visit


def foresee_all(visit: Visit) -> None:
    """Add to a visit what timers and event handlers will start, as far as that is known. Raises DocumentError."""
    with surroundings(visit.maker.home) as absences:
        absences.say = visit.context.said.append
        visit.foresee()


def arguments_of(path: Path, workspace: Folder = None) -> list[ArgumentHelp]:
    """Return the arguments that a launch file and those that it includes declare, in their order.

    Args:
        path: The launch file.
        workspace: As for `visited`.

    Raises:
        DocumentError: for a mistake, with the file and line of the user's code.
    """
    path = path.absolute()
    with surroundings(home_of(path, workspace)):
        context = LaunchContext()
        visit = Visit(context, EntryMaker(None, context.said.append), path)
        with visit.placing(None):
            description = AnyLaunchDescriptionSource(str(path)).get_launch_description(context)
            return [_help(each, context) for each in _declared(description, path, context)]


def _declared(description: LaunchDescription, path: Path, context: LaunchContext) -> list[DeclareLaunchArgument]:
    """Return the arguments that the description in the file at `path` declares, each name once.

    Raises DocumentError where files include each other in a circle, and none of them declares any.
    """
    found: dict[str, DeclareLaunchArgument] = {}
    circles = []
    for each in described(Described(description, (str(path),)), context):
        if isinstance(each.entity, DeclareLaunchArgument):
            found.setdefault(each.entity.name, each.entity)
        elif each.circle and each.is_certain:
            circles.append(DocumentError(each.circle, each.place.file, each.place.line))
    if circles and not found:
        raise circles[0]
    context.extend_locals({FILES[0]: str(path), FILES[1]: str(path.parent)})
    return list(found.values())


def _included(path: Path, description: LaunchDescription | None) -> LaunchDescriptionEntity:
    """Return the action that includes the launch file itself; it has no place of its own."""
    read = LaunchDescriptionSource(description, str(path)) if description is not None else None
    action = IncludeLaunchDescription(read or AnyLaunchDescriptionSource(str(path)))
    action.place = action.place._replace(file="", line=0)
    return action


def _help(declared: DeclareLaunchArgument, context: LaunchContext) -> ArgumentHelp:
    default = None
    if declared.default_value is not None:
        try:
            default = perform_substitutions(context, declared.default_value)
        except (LaunchError, DocumentError):
            default = "".join(getattr(each, "text", each.describe()) for each in declared.default_value)
        context.launch_configurations.setdefault(declared.name, default)
    return ArgumentHelp(declared.name, default, declared.about, tuple(declared.choices or ()))


def _note_unread(context: LaunchContext, given: Mapping[str, str]) -> None:
    """Add a line for each given argument that nothing has declared or read: ROS 2 takes them in silence."""
    for name in given:
        if name not in context.requested:
            hint = nearest(name, context.requested) or f": there is {', '.join(sorted(context.requested)) or 'none'}"
            context.said.append(f"nothing reads the argument '{shown(name)}'{hint}")
