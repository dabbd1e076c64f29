"""`launch.frontend` as a library: parsers and elements, and programs' own actions and substitutions in XML and YAML."""

from __future__ import annotations

import io
from collections.abc import Iterator
from pathlib import Path
from typing import Any, List  # noqa: UP035 - ROS 2 names its list types by it

import pytest

from robolink.exceptions import DocumentError
from robolink.launch.ros import launch_xml, launch_yaml
from robolink.launch.ros.launch import bases, typed_values
from robolink.launch.ros.launch.actions import Log, LogInfo
from robolink.launch.ros.launch.bases import Action, LaunchContext, LaunchError, Substitution
from robolink.launch.ros.launch.frontend import Entity, InvalidFrontendLaunchFileError, Parser, expose
from robolink.launch.ros.launch.frontend.expose import expose_action, expose_substitution
from robolink.launch.ros.launch.frontend.parse_substitution import parse_if_substitutions, parse_substitution
from robolink.launch.ros.launch.frontend.type_utils import get_data_type_from_identifier
from robolink.launch.ros.launch.sources import FrontendLaunchDescriptionSource, LaunchDescription
from robolink.launch.ros.launch.utilities import perform_substitutions
from robolink.launch.ros.launch_ros.actions import Node
from robolink.launch.system import read_system

XML = """<launch>
  <one size="2.5" names="a,b" names-sep="," flag="1" text="x">
    <two value="1"/>
    <two value="2"/>
  </one>
</launch>"""
YAML = """launch:
- one: {size: 2.5, names: [a, b], flag: true, text: x, two: [{value: "1"}, {value: "2"}]}
"""


@pytest.fixture
def names() -> Iterator[None]:
    """Names of actions and substitutions are as before afterwards."""
    expose.add_own()
    tables: tuple[dict[str, Any], ...] = (expose.action_parse_methods, expose.substitution_parse_methods)
    before = [dict(each) for each in tables]
    yield
    for table, kept in zip(tables, before, strict=True):
        table.clear()
        table.update(kept)


def load(text: str) -> tuple[Entity, Parser]:
    return Parser.load(io.StringIO(text))


def description(text: str) -> LaunchDescription:
    entity, parser = load(text)
    return parser.parse_description(entity)


def said(text: str, **configurations: str) -> list[str]:
    """Return the lines that the actions of a launch file write."""
    context = LaunchContext()
    context.launch_configurations.update(configurations)
    waiting: list[Any] = [description(text)]
    while waiting:
        waiting[:1] = waiting[0].visit(context) or []
    return context.said


@pytest.mark.parametrize("text", [XML, YAML])
def test_elements_have_attributes_of_types(text: str) -> None:
    top, parser = load(text)
    (one,) = top.children
    assert type(parser) is (launch_xml.Parser if text is XML else launch_yaml.Parser)
    assert (top.type_name, one.type_name, one.parent, top.parent) == ("launch", "one", top, None)
    assert one.get_attr("size", data_type=float) == 2.5
    assert one.get_attr("names", data_type=List[str]) == ["a", "b"]  # noqa: UP006
    assert one.get_attr("names", data_type=list[str]) == ["a", "b"]
    assert one.get_attr("flag", data_type=bool) is True
    assert one.get_attr("lacking", optional=True) is None
    with pytest.raises(ValueError, match=r"<text>:2: one: no attribute is called 'text'"):
        one.assert_entity_completely_parsed()
    assert one.get_attr("text") == "x"
    with pytest.raises(ValueError, match="two"):
        one.assert_entity_completely_parsed()
    twos = one.get_attr("two", data_type=List[Entity])  # noqa: UP006
    assert [each.get_attr("value") for each in twos] == ["1", "2"]
    one.assert_entity_completely_parsed()


@pytest.mark.parametrize("text", [XML, YAML])
def test_what_is_lacking_or_of_another_type_is_a_standard_error_with_its_line(text: str) -> None:
    (one,) = load(text)[0].children
    with pytest.raises(AttributeError, match="<text>:2: one: 'lacking' is missing"):
        one.get_attr("lacking")
    with pytest.raises(AttributeError, match="did you mean 'sizes'"):
        one.get_attr("sizes")
    with pytest.raises(TypeError, match="<text>:2: one: 'text': expected"):
        one.get_attr("text", data_type=int, can_be_str=False)
    with pytest.raises(AttributeError, match="'three' is missing"):
        one.get_attr("three", data_type=List[Entity])  # noqa: UP006


def test_files_are_read_by_their_names_and_what_no_parser_reads_has_all_reasons(tmp_path: Path) -> None:
    assert list(Parser.get_available_extensions()) == ["xml", "yaml"]
    assert Parser.is_filename_valid("a.launch.yml")
    assert not Parser.is_filename_valid("a.launch.py")
    path = tmp_path / "a.launch.yaml"
    path.write_text(YAML)
    assert isinstance(Parser.load(path)[0], launch_yaml.Entity)
    path.write_text("<launch")
    with pytest.raises(
        InvalidFrontendLaunchFileError, match=r"of the kind 'yaml': .*a\.launch\.yaml.*no XML"
    ) as caught:
        Parser.load(str(path))
    assert len(caught.value.likely_errors) == 2
    with pytest.raises(DocumentError, match="<text>:1: a launch file begins with <launch>"):
        description("<robot/>")


def test_a_parser_of_ones_own_reads_its_own_language(tmp_path: Path) -> None:
    class Lines(Parser):
        @classmethod
        def load(cls, file: Any) -> tuple[Entity, Parser]:
            logs = "".join(f"<log message='{each}'/>" for each in Path(file).read_text().split())
            return launch_xml.Parser.load(io.StringIO(f"<launch>{logs}</launch>"))

    path = tmp_path / "a.lines"
    path.write_text("one two")
    found = FrontendLaunchDescriptionSource(str(path), parser=Lines).get_launch_description(LaunchContext())
    assert [perform_substitutions(LaunchContext(), each.msg) for each in found.entities] == ["one", "two"]  # type: ignore[attr-defined]


@pytest.mark.usefixtures("names")
def test_an_own_action_adds_to_what_its_base_reads() -> None:
    @expose_action("speak")
    class Speak(LogInfo):
        @classmethod
        def parse(cls, entity: Any, parser: Any, ignore: Any = ()) -> Any:
            _, kwargs = super().parse(entity, parser)
            times = entity.get_attr("times", data_type=int)
            return cls, {**kwargs, "msg": [*kwargs["msg"], f" {times}"]}

    @expose_action("shout")
    def shout(entity: Any, parser: Any) -> Any:
        return LogInfo, {"msg": parser.parse_substitution(entity.get_attr("text"))}

    assert said('<launch><speak message="a" times="2" if="true"/><shout text="$(var b)"/></launch>', b="c") == [
        "a 2",
        "c",
    ]
    assert said("launch:\n- speak: {message: a, times: 2, unless: 'true'}\n- shout: {text: b}\n") == ["b"]
    with pytest.raises(DocumentError, match="<text>:2: speak: no attribute is called 'tmes'"):
        description('<launch>\n<speak message="a" times="2" tmes="3"/></launch>')
    with pytest.raises(RuntimeError, match="there is action 'speak' already"):
        expose_action("speak")(LogInfo)
    with pytest.raises(RuntimeError, match="there is action 'node' already"):
        expose_action("node")(shout)
    with pytest.raises(RuntimeError, match="no class method parse"):
        expose_action("other")(LaunchContext)
    with pytest.raises(RuntimeError, match="a class with parse"):
        expose_action("other")(5)


@pytest.mark.usefixtures("names")
def test_an_own_substitution_gets_its_arguments() -> None:
    @expose_substitution("twice")
    class Twice(Substitution):
        def __init__(self, texts: list[list[Substitution]]) -> None:
            self.texts = texts

        @classmethod
        def parse(cls, data: Any) -> Any:
            return cls, {"texts": data}

        def perform(self, context: LaunchContext) -> str:
            return "".join(2 * perform_substitutions(context, each) for each in self.texts)

    assert said('<launch><log message="$(twice a $(var b)) $(twice)"/></launch>', b="c") == ["aacc "]


OWN = """
from launch import Action
from launch.actions import LogInfo
from launch.frontend import expose_action, expose_substitution
from launch.substitutions import TextSubstitution
from launch_ros.actions import Node


@expose_action("robot")
class Robot(Node):
    @classmethod
    def parse(cls, entity, parser):
        _, kwargs = super().parse(entity, parser)
        kwargs["parameters"] = [{"word": entity.get_attr("says")}]
        return cls, kwargs


@expose_substitution("upper")
def upper(data):
    return TextSubstitution, {"text": data[0][0].text.upper()}
"""


@pytest.mark.usefixtures("names")
@pytest.mark.parametrize("file", ["setup.py", "setup.cfg"])
def test_a_package_of_the_workspace_exposes_its_own_by_entry_points(
    package: Path, file: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(Parser, "_workspaces", set())
    (package / "bot" / "frontend.py").write_text(OWN)
    group = "launch.frontend.launch_extension"
    if file == "setup.py":
        (package / file).write_text(
            f"from setuptools import setup\nsetup(entry_points={{'{group}': ['b = bot.frontend']}})"
        )
    else:
        (package / file).write_text(f"[options.entry_points]\n{group} =\n  bot = bot.frontend\n")
    path = package / "launch" / "bot.launch.xml"
    path.write_text("<launch>\n<robot pkg='bot' exec='talker.py' says='$(upper x)' name='r'/></launch>")
    (entry,) = read_system(path, {}).entries
    assert (entry.name, entry.node.parameters) == ("r", {"word": "$(upper x)"})
    path.write_text("<launch>\n<log message='$(upper x)'/></launch>")
    assert read_system(path, {}).notes == ["X"]
    path.write_text("<launch>\n<robt/></launch>")
    with pytest.raises(DocumentError, match=r"xml:2: robt: there is no such element \(did you mean 'robot'\?\)"):
        read_system(path, {})


@pytest.mark.usefixtures("names")
def test_an_extension_that_does_not_load_warns_and_the_others_go_on(
    package: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(Parser, "_workspaces", set())
    (package / "setup.cfg").write_text(
        "[options.entry_points]\nlaunch.frontend.launch_extension =\n  a = bot.lacking\n  b = bot.frontend\n"
    )
    (package / "bot" / "frontend.py").write_text(OWN)
    path = package / "launch" / "bot.launch.xml"
    path.write_text("<launch><log message='$(upper x)'/></launch>")
    with pytest.warns(UserWarning, match="Failed to load the launch extension: bot.lacking: ModuleNotFoundError"):
        assert read_system(path, {}).notes == ["X"]


def test_an_element_of_another_front_end_needs_only_the_methods_of_entity() -> None:
    class Mine(Entity):
        def __init__(self, tag: str, **values: Any) -> None:
            self._name, self._values = tag, values

        @property
        def type_name(self) -> str:
            return self._name

        @property
        def children(self) -> list[Any]:
            return list(self._values.get("children", []))

        def get_attr(self, name: str, *, data_type: Any = str, optional: bool = False, can_be_str: bool = True) -> Any:
            if name not in self._values and not optional:
                raise AttributeError(name)
            return self._values.get(name)

        def assert_entity_completely_parsed(self) -> None:
            pass

    made = Parser().parse_action(Mine("node", pkg="p", exec="e", param=[Mine("param", name="a", value=1)]))
    assert isinstance(made, Node)
    group = Parser().parse_action(Mine("group", children=[Mine("log", message="x", level="error")]))
    inside = [each for each in group.get_sub_entities() if isinstance(each, Log)]
    assert [perform_substitutions(LaunchContext(), each.level) for each in inside] == ["error"]
    with pytest.raises(AttributeError, match="exec"):
        Parser().parse_action(Mine("node", pkg="p"))


LOOPS = """<launch>
  <for_each values="{name: a, n: 1};{name: b}">
    <for len="$(for-var n 2)" name="i">
      <log message="$(for-var name)$(index i)"/>
    </for>
  </for_each>
</launch>"""
YAML_LOOPS = """launch:
- for_each:
    values: "{name: a, n: 1};{name: b}"
    children:
    - for: {len: $(for-var n 2), name: i, children: [{log: {message: $(for-var name)$(index i)}}]}
"""


@pytest.mark.parametrize("text", [LOOPS, YAML_LOOPS])
def test_loops_have_their_own_values_in_each_iteration(text: str) -> None:
    assert said(text) == ["a0", "b0", "b1"]


def test_each_iteration_starts_processes_of_its_own(package: Path) -> None:
    path = package / "launch" / "bot.launch.xml"
    path.write_text("<launch><for len='2' name='i'><node pkg='bot' exec='talker' name='n$(index i)'/></for></launch>")
    assert [each.name for each in read_system(path, {}).entries] == ["n0", "n1"]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("<log message='$(for-var x)'/>", "no loop here has the value 'x'"),
        ("<for len='2' name='i'><log message='$(index j)'/></for>", "no loop here has the value 'j'"),
        ("<for len='2'/>", "for: 'name' is missing"),
        ("<for len='x' name='i'/>", "the length of a loop is a number from 0 on, got 'x'"),
        ("<for len='1' name='i'><lg/></for>", "lg: there is no such element (did you mean 'log'?)"),
        ("<for_each values='a'/>", "a mapping such as {name: ada} is expected, got 'a'"),
        ("<bool_arg name='b' default='maybe'/>", "'b' is one of true, false, True, False, TRUE, FALSE, got 'maybe'"),
        ("<bool_arg name='b'><choice value='x'/></bool_arg>", "choice: 'bool_arg' holds no 'choice': it holds none"),
        ("<log message='x' level='loud'/>", "no level is called 'LOUD': there is CRITICAL, FATAL, ERROR, WARNING"),
        ("<log_debug message='x' level='info'/>", "log_debug: no attribute is called 'level'"),
        ("<log message='$(string-join .)'/>", "log: $(string-join ...) takes 2 or more arguments, got 1"),
    ],
)
def test_what_is_new_has_its_mistakes_in_one_line(package: Path, text: str, message: str) -> None:
    path = package / "launch" / "bot.launch.xml"
    path.write_text(f"<launch>\n{text}</launch>")
    with pytest.raises(DocumentError) as caught:
        read_system(path, {})
    assert (caught.value.line, caught.value.message[: len(message)]) == (2, message)


def test_lines_have_their_level(package: Path) -> None:
    path = package / "launch" / "bot.launch.xml"
    path.write_text(
        "<launch><bool_arg name='b' default='True'/><log_info message='1'/><log_warning message='2'/>"
        "<log_error message='3'/><log_debug message='4'/><log message='5' level='$(if $(var b) warn info)'/>"
        "<log message='$(string-join , a b$(var b))'/></launch>"
    )
    notes = read_system(path, {}).notes
    assert [(str(each), getattr(each, "severity", "")) for each in notes] == [
        ("1", "INFO"),
        ("2", "WARN"),
        ("3", "ERROR"),
        ("5", "WARN"),
        ("a,bTrue", "INFO"),
    ]


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("$(eval \"'$(var a)' + 'b'\")", "xb"),
        ("$(eval 'sys.maxsize > 0 and ceil(0.5)' 'math, sys')", "1"),
        ("$(env NOT_SET_AT_ALL \"it's $(env NOT_SET_EITHER 'q')\")", "it's 'q'"),
        ("$(env NOT_SET_AT_ALL '')|", "|"),
        ("$(path-join $(var a) b)", "x/b"),
    ],
)
def test_quotes_and_modules_are_as_in_ros(text: str, value: str) -> None:
    context = LaunchContext()
    context.launch_configurations["a"] = "x"
    assert perform_substitutions(context, parse_substitution(text)) == value


def test_quotes_of_one_kind_stand_in_each_other_with_a_backslash_only() -> None:
    found = parse_substitution('$(env NOT_SET_AT_ALL "$(env NOT_SET_EITHER \\"b\\")")')
    assert perform_substitutions(LaunchContext(), found) == '"b"'
    with pytest.raises(ValueError, match="the other quotes around"):
        parse_substitution('$(env A "$(env B "b")")')


def test_values_keep_their_types_where_they_have_no_substitutions() -> None:
    assert parse_if_substitutions([1, 2]) == [1, 2]
    assert parse_if_substitutions("a") == "a"
    assert [each.describe() for each in parse_if_substitutions("$(var a)b")] == ["LaunchConfig('a')", "'b'"]
    with pytest.raises(ValueError, match="a list of one type"):
        parse_if_substitutions([1, 2.0])
    assert get_data_type_from_identifier("list_of_int") == List[int]  # noqa: UP006
    with pytest.raises(ValueError, match="no type is called 'double': float"):
        get_data_type_from_identifier("double")


@pytest.mark.parametrize("name", ["SomeSubstitutionsType", "SomeEntitiesType", "SomeActionsType"])
def test_types_of_annotations_are_types(name: str) -> None:
    assert type(None) in (getattr(bases, name) | None).__args__


def test_types_of_typed_values_are_types() -> None:
    names = [each for each in typed_values.__all__ if each.endswith("Type") and each[0].isupper()]
    assert all(type(None) in (getattr(typed_values, each) | None).__args__ for each in names)


def test_an_action_without_attributes_of_its_own_has_a_condition_only() -> None:
    class Plain(Action):
        pass

    (entity,) = load("<launch><x if='true'/></launch>")[0].children
    cls, arguments = Plain.parse(entity, Parser())
    assert (cls, list(arguments)) == (Plain, ["condition"])
    (entity,) = load("<launch><x if='true' unless='true'/></launch>")[0].children
    with pytest.raises(DocumentError, match="one of them is enough"):
        Plain.parse(entity, Parser())
    assert issubclass(LaunchError, RuntimeError)
