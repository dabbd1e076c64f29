"""Launch descriptions give nodes what ROS 2's own launch gives them: parameters, names, environment (recorded)."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pytest

from robolink.context import Context
from robolink.exceptions import RobolinkError
from robolink.launch.entry import Entry
from robolink.launch.planning import arguments, environment
from robolink.launch.system import read_system
from robolink.node import Node
from robolink.supervisor.director import Add, Director, End, Request, Tell
from robolink.utilities import remove_ros_args
from tests.support.launch_descriptions import INHERITED, Description, descriptions, recorded, write_files

DOCS = Path(__file__).parents[3] / "docs" / "reference" / "ros_launch.md"
PROGRAM = "import rclpy\nfrom rclpy.node import Node\n\n\nclass Show(Node):\n    pass\n\n\ndef main():\n    pass\n"
RECORDED = recorded()
DIFFERENT = {
    "dict_texts_pyyaml_writes_bare.launch.py": "a text of a Python file stays a text",
    "set_parameter_lists.launch.py": "A list of `SetParameter` arrives as one",
    "xml_set_parameter.launch.xml": "A list of `SetParameter` arrives as one",
    "set_parameter_list_aliases_group.launch.py": "`SetParameter` in a group ends with the group",
    "xml_set_use_sim_time.launch.xml": "`<set_use_sim_time>` is told to set no node's clock",
    "event_scope.launch.py": "`LaunchConfiguration`s of a group are still there",
    "path_join.launch.py": "within `PathJoinSubstitution`",
    "loops.launch.py": "`ForEach` and `ForLoop`",
    "xml_include_let.launch.xml": "`<let>` within `<include>`",
    "xml_any_all.launch.xml": "`$(any ...)`",
    "xml_log_level.launch.xml": "`level` of `<log>`",
    "yaml_respawn_true.launch.yaml": "`respawn: true`",
    "xml_choice_extra.launch.xml": "Unknown attributes of `<choice>`",
}
"""Descriptions of which ours makes something else, each with the words that docs/reference/ros_launch.md has for it."""
PROCESSES = ("command.launch.py", "xml_command.launch.xml")
"""Descriptions that run commands."""


@pytest.fixture(scope="module")
def here(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Folder of the descriptions, in a workspace with the package `judge`."""
    top = tmp_path_factory.mktemp("beside").resolve()
    package = top / "src" / "judge"
    (package / "judge").mkdir(parents=True)
    (package / "package.xml").write_text("<package><name>judge</name></package>")
    scripts = "{'console_scripts': ['show = judge.show:main']}"
    (package / "setup.py").write_text(f"from setuptools import setup\nsetup(name='judge', entry_points={scripts})\n")
    (package / "judge" / "__init__.py").write_text("")
    (package / "judge" / "show.py").write_text(PROGRAM)
    (package / "launch").mkdir()
    write_files(package / "launch")
    return package / "launch"


@pytest.fixture(autouse=True)
def surroundings(package: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The names of ROS 2 are as before afterwards, and the environment is that of the recording."""
    for name, value in INHERITED.items():
        monkeypatch.setenv(name, value)


@dataclass
class Play:
    """A launch, played without processes: programs end at once, those with the word `stay` at the end of the launch."""

    context: Context
    said: list[str] = field(default_factory=list)
    nodes: list[dict[str, Any]] = field(default_factory=list)
    error: str = ""
    is_over: bool = False
    now: float = 0.0
    director: Director[Entry] | None = None
    waiting: list[Entry] = field(default_factory=list)
    alive: list[Entry] = field(default_factory=list)

    def play(self, path: Path, given: dict[str, str]) -> None:
        """Play a launch file from its begin to its end."""
        try:
            system = read_system(path, given)
        except RobolinkError as error:
            self.error = str(error)
            return
        self.said += system.notes
        self.waiting += system.entries
        if system.direct is not None:
            self.director = system.direct(self)
            self.follow(self.director.begin(self.now))
        while self.step() and not self.is_over:
            pass
        self.is_over = True
        if self.director is not None:
            self.follow(self.director.stopping(self.now))

    def step(self) -> bool:
        """Start or end what is next; False if nothing is."""
        if self.waiting:
            entry = self.waiting.pop(0)
            self.nodes.append(self.node_of(entry))
            self.alive.append(entry)
            if self.director is not None:
                self.follow(self.director.started(entry.name, 1, self.now))
            return True
        ending = next((each for each in self.alive if "stay" not in each.node.args), None)
        if ending is not None:
            self.alive.remove(ending)
            code = next((int(each[5:]) for each in ending.node.args if each.startswith("exit=")), 0)
            if self.director is not None:
                self.follow(self.director.exited(ending.name, code, self.now))
            self.is_over |= ending.node.on_exit == "shutdown"
            return True
        if self.director is None or self.director.deadline is None:
            return False
        self.now = self.director.deadline
        self.follow(self.director.woken(self.now))
        return True

    def follow(self, requests: Sequence[Request[Entry]]) -> None:
        """Do what the director asks for."""
        for each in requests:
            if isinstance(each, Add):
                self.waiting.append(each.process)
            elif isinstance(each, Tell):
                self.said.append(each.text)
            elif isinstance(each, End):
                self.is_over = True
                self.error = each.reason if each.code else self.error

    def node_of(self, entry: Entry) -> dict[str, Any]:
        """Return the parameters and names of an entry's node, as the recording's program says them."""
        words = list(arguments(entry))
        env = {**INHERITED, **environment(entry)}
        seen: dict[str, Any] = {
            "args": remove_ros_args(["show", *words])[1:],
            "env": {name: value for name, value in sorted(env.items()) if name.startswith("X_") and value is not None},
        }
        node = Node(
            "show",
            context=self.context,
            cli_args=words,
            use_global_arguments=False,
            automatically_declare_parameters_from_overrides=True,
            start_parameter_services=False,
        )
        with node:
            return {**seen, **_shown(node)}

    # Stage

    def plan(self, entries: list[Entry]) -> Sequence[Entry]:
        return entries

    def with_node(self, act: Callable[[Node], object]) -> None:
        raise AssertionError("no node was expected")

    def post(self, act: Callable[[float], Sequence[Request[Entry]]]) -> None:
        raise AssertionError("nothing was expected")


def _shown(node: Node) -> dict[str, Any]:
    names = set(node.get_parameters_by_prefix("")) - {"use_sim_time", "start_type_description_service"}
    if node.get_parameter("use_sim_time").value:
        names.add("use_sim_time")
    values = {name: node.get_parameter(name) for name in names}
    return {
        "name": node.get_fully_qualified_name(),
        "parameters": {
            name: [each.type_.name, each.value if isinstance(each.value, (str, bool, int, float)) else list(each.value)]
            for name, each in sorted(values.items())
        },
        "topics": [node.resolve_topic_name(name) for name in ("chatter", "scan")],
    }


def _differences(description: Description, here: Path, context: Context) -> list[str]:
    """Return where ours does otherwise than ROS 2's launch."""
    theirs = RECORDED[description.name]
    ours = Play(context)
    ours.play(description.write(here), description.given)
    has_failed = bool(theirs["error"] or any("error" in each for each in theirs["nodes"]))
    if has_failed and ours.error:
        return []
    if theirs["error"] or ours.error:
        return [f"error: {theirs['error']!r}, here {ours.error!r}"]
    found = []
    place = f"{here.as_posix()}/"
    said = [each.replace(place, "here/") for each in ours.said]
    if not _is_within(theirs["said"], said):
        found.append(f"said: {theirs['said']}, here {said}")
    nodes = sorted(ours.nodes, key=lambda each: str(each["name"]))
    if len(nodes) != len(theirs["nodes"]):
        found.append(f"nodes: {len(theirs['nodes'])}, here {len(nodes)}")
    for one, other in zip(theirs["nodes"], nodes, strict=False):
        found += [
            f"{key}: {one.get(key)}, here {value}" for key, value in other.items() if repr(one.get(key)) != repr(value)
        ]
    return found


def _is_within(few: Sequence[str], many: Sequence[str]) -> bool:
    """True if `many` has all of `few`, in their order: ours says more of what it does."""
    rest = iter(many)
    return all(any(each == other for other in rest) for each in few)


def _marked(description: Description) -> Any:
    marks = [pytest.mark.processes] if description.name in PROCESSES else []
    return pytest.param(description, id=description.name, marks=marks)


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore:LaunchConfiguration(Not)?Equals is deprecated")  # there, too
@pytest.mark.parametrize("description", [_marked(each) for each in descriptions()])
def test_a_description_does_what_it_does_in_ros(description: Description, here: Path, context: Context) -> None:
    found = _differences(description, here, context)
    if description.name not in DIFFERENT:
        assert not found, "\n".join(found)
        return
    assert found, "it no longer differs"
    assert DIFFERENT[description.name] in DOCS.read_text(encoding="utf-8").partition("## Differences")[2]


def test_all_are_recorded() -> None:
    assert set(RECORDED) == {each.name for each in descriptions()}
