"""ROS 2's launch files in XML and YAML: the same nodes as in Python, and mistakes at their lines."""

from __future__ import annotations

import contextlib
import sys
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from robolink.cli.main import main
from robolink.exceptions import DocumentError
from robolink.interfaces.std_msgs.msg import String
from robolink.launch.entry import System as LaunchSystem
from robolink.launch.lookup import is_of_ros
from robolink.launch.ros.launch.frontend.parse_substitution import parse_substitution, words_of
from robolink.launch.system import arguments_of, read_system
from robolink.testing import System
from tests.support.launched_systems import said
from tests.support.ros_launch import write

XML = """<?xml version="1.0"?>
<launch>
  <arg name="word" default="hello" description="The word."><choice value="hello"/><choice value="ho"/></arg>
  <let name="folder" value="$(find-pkg-share bot)/config"/>
  <set_env name="LEVEL" value="3"/>
  <log message="$(var folder) $(env NOT_SET_AT_ALL none) $(eval '1 + 2')"/>
  <group>
    <push-ros-namespace namespace="g"/>
    <set_remap from="other" to="/else"/>
    <node pkg="bot" exec="talker" name="one" namespace="in" output="screen"
          args="--fast $(var word)x" respawn="true">
      <param name="word" value="$(var word)"/>
      <param name="n" value="5"/>
      <param name="text" value="5" type="str"/>
      <param name="arm"><param name="gain" value="1.5"/><param name="list" value="1, 2" value-sep=","/></param>
      <param from="$(var folder)/p.yaml"/>
      <remap from="chatter" to="said"/>
      <env name="A" value="b"/>
    </node>
  </group>
  <node pkg="bot" exec="talker" name="off" if="$(eval '1 == 2')"/>
  <node pkg="bot" exec="once" unless="false" on_exit="shutdown"/>
  <executable cmd="ros2 topic list" name="lister"/>
  <node pkg="controller_manager" exec="spawner"/>
</launch>
"""
YAML = """\
# a comment
launch:
- arg: {name: word, default: hello, description: The word., choice: [{value: hello}, {value: ho}]}
- let: {name: folder, value: $(find-pkg-share bot)/config}
- set_env: {name: LEVEL, value: "3"}
- log: {message: "$(var folder) $(env NOT_SET_AT_ALL none) $(eval '1 + 2')"}
- group:
  - push_ros_namespace: {namespace: g}
  - set_remap: {from: other, to: /else}
  - node:
      pkg: bot
      exec: talker
      name: one
      namespace: in
      args: "--fast $(var word)x"
      respawn: true
      output: screen
      param:
      - {name: word, value: $(var word)}
      - {name: n, value: 5}
      - {name: text, value: "5"}
      - {name: arm, param: [{name: gain, value: 1.5}, {name: list, value: [1, 2]}]}
      - from: $(var folder)/p.yaml
      remap: [{from: chatter, to: said}]
      env: [{name: A, value: b}]
- node: {pkg: bot, exec: talker, name: "off", if: "$(eval '1 == 2')"}
- node:
    pkg: bot
    exec: once
    unless: "false"
    on_exit: shutdown
- executable: {cmd: ros2 topic list, name: lister}
- node: {pkg: controller_manager, exec: spawner}
"""


def put(package: Path, text: str, name: str) -> Path:
    path = package / "launch" / name
    path.write_text(text)
    return path


def load(package: Path, text: str, name: str, **given: str) -> LaunchSystem:
    return read_system(put(package, text, name), given)


@pytest.mark.parametrize(("text", "name"), [(XML, "bot.launch.xml"), (YAML, "bot.launch.yaml")])
def test_both_say_the_same(package: Path, text: str, name: str) -> None:
    (package / "config" / "p.yaml").write_text("/**: {ros__parameters: {period: 2.0}}\n")
    system = load(package, text, name, word="ho")
    one, once, lister = system.entries
    assert (one.name, one.node.args) == ("g/in/one", ["--fast", "hox"])
    assert one.node.parameters == {
        "word": "ho", "n": 5, "text": "5", "arm.gain": 1.5, "arm.list": [1, 2], "period": 2.0,
    }  # fmt: skip
    assert one.node.remappings == {"other": "/else", "chatter": "said"}
    assert (one.node.env, one.node.respawn.when) == ({"LEVEL": "3", "A": "b"}, "always")
    assert (once.name, once.node.on_exit) == ("once", "shutdown")
    assert (lister.name, lister.node.run[-2:]) == ("lister", ["topic", "list"])
    line = text[: text.index("spawner")].count("\n") + 1
    assert system.notes[0] == f"{package}/config none 3"
    assert system.notes[1].startswith(f"{name}:{line}: left out: controller_manager spawner")
    (argument,) = arguments_of(package / "launch" / name)
    assert argument == type(argument)("word", "hello", "The word.", ("hello", "ho"))


@pytest.mark.parametrize(
    ("text", "name"),
    [
        ("<launch>\n<node exec='{}' name='n'/></launch>", "bot.launch.xml"),
        ("launch:\n- node: {{exec: {}, name: n}}\n", "bot.launch.yaml"),
    ],
)
def test_a_node_without_a_package_is_a_program_by_its_path(package: Path, text: str, name: str) -> None:
    (started,) = load(package, text.format(sys.executable), name).entries
    assert started.name == "n"
    assert started.source
    assert started.source.path
    assert started.source.path.samefile(sys.executable)


def test_files_of_all_kinds_include_each_other(package: Path, system: System) -> None:
    put(
        package,
        '<launch><include file="$(dirname)/b.launch.yaml"><arg name="w" value="x"/></include></launch>',
        "a.launch.xml",
    )
    put(
        package,
        "launch:\n- arg: {name: w}\n- include: {file: $(dirname)/c.launch.py, arg: [{name: w, value: $(var w)y}]}\n",
        "b.launch.yaml",
    )
    write(
        package,
        'Node(package="bot", executable="talker", parameters=[{"word": LaunchConfiguration("w")}])',
        "c.launch.py",
    )
    path = write(
        package,
        """
        def generate_launch_description():
            from launch_xml.launch_description_sources import XMLLaunchDescriptionSource
            return LaunchDescription([IncludeLaunchDescription(XMLLaunchDescriptionSource(
                [ThisLaunchFileDir(), "/a.launch.xml"]))])
        """,
    )
    system.launch(path)
    assert system.expect("chatter", type=String).data == "xy"


def test_timers_containers_and_lifecycle_nodes(package: Path) -> None:
    system = load(
        package,
        """<launch>
        <node_container pkg="rclcpp_components" exec="component_container" name="box" namespace="ns">
          <composable_node pkg="bot" plugin="bot::Talker" name="a"><param name="word" value="x"/></composable_node>
        </node_container>
        <load_composable_node target="/ns/box">
          <composable_node pkg="bot" plugin="bot::Talker" name="b">
            <extra_arg name="use" value="true"/>
          </composable_node>
        </load_composable_node>
        <lifecycle_node pkg="bot" exec="talker" name="live" namespace="" autostart="true"/>
        <timer period="3"><node pkg="bot" exec="talker" name="late"/><shutdown reason="x"/></timer>
        </launch>""",
        "bot.launch.xml",
    )
    assert [(each.name, each.node.process) for each in system.entries] == [
        ("a", "ns/box"),
        ("b", "ns/box"),
        ("live", ""),
    ]
    assert system.direct is not None


WRONG_XML = [
    ("<launch>\n<nod/></launch>", 2, "nod: there is no such element (did you mean 'node'?)"),
    ("<launch>\n<node pkg='bot'/></launch>", 2, "node: 'exec' is missing"),
    ("<launch>\n<node pkg='bot' exec='talker' nmae='x'/></launch>", 2, "node: no attribute is called 'nmae' (did you"),
    ("<launch>\n<node pkg='bot' exec='talker'>\n<parm/></node></launch>", 3, "parm: 'node' holds no 'parm' (did"),
    ("<launch>\n<log message='$(vra x)'/></launch>", 2, "log: no substitution is called 'vra' (did you mean 'var'?)"),
    ("<launch>\n<log message='$(arg x)'/></launch>", 2, "log: $(arg ...) is ROS 1: $(var ...) is what ROS 2 has"),
    ("<launch>\n<log message='$(var x)'/></launch>", 2, "no launch argument is called 'x'"),
    ("<launch>\n<node pkg='bot' exec='talkr'/></launch>", 2, "no executable named 'talkr' in package bot (did"),
    ("<launch>\n<include file='$(dirname)/bot.launch.xml'/></launch>", 2, "a launch file cannot include itself: "),
    ("<launch>\n<log message='x' if='true' unless='true'/></launch>", 2, "log: it has 'if' and 'unless': one of them"),
    ("<launch>\nhello</launch>", 1, "launch: text stands in attributes, got 'hello'"),
    ("<launch>\n<node></launch>", 2, "no XML: mismatched tag"),
    (
        "<launch>\n<arg name='a' default='$(find p)'/>\n<node name='x' pkg='p' type='x.py' required='true'/></launch>",
        3,
        'a launch file of ROS 1; in ROS 2 $(find x) is $(find-pkg-share x); type= is exec=; required="true" is on_exit',
    ),
    ("<launch>\n<rosparam>a: 1</rosparam></launch>", 2, "a launch file of ROS 1; in ROS 2 <rosparam> is <param from"),
    ("<launch>\n<node pkg='p' exec='x' type='y'/></launch>", 2, "node: no attribute is called 'type'"),
    ("<robot/>", 1, "a launch file begins with <launch>"),
    ("<!DOCTYPE x [\n<!ENTITY a 'b'>]>\n<launch/>", 2, "no entities are declared here, such as 'a'"),
    ("<launch>" * 70, 1, "nested over 64 deep, or more than 100,000 elements"),
    ("", 1, "no XML: no element found"),
]  # fmt: skip
WRONG_YAML = [
    ("launch:\n- nod: {}\n", 2, "nod: there is no such element (did you mean 'node'?)"),
    ("launch:\n- node: {pkg: bot}\n", 2, "node: 'exec' is missing"),
    ("launch:\n- node: talker\n", 2, "node: a mapping of its attributes is expected"),
    ("launch:\n- node\n", 2, "each action is a mapping with one key, such as `- node: {...}`"),
    ("launch:\n- log: {message: {a: b}}\n", 2, "log: 'message' is one value, not a mapping"),
    ("launch: []\nother: []\n", 1, "a launch file of ROS 2 has one key, `launch`, with a list of actions"),
    ("launch: []\nnodes: []\n", 1, "it is one of robolink's own launch files, and those of ROS 2 include none of"),
]


@pytest.mark.parametrize(
    ("name", "text", "line", "message"),
    [*(("bot.launch.xml", *each) for each in WRONG_XML), *(("bot.launch.yaml", *each) for each in WRONG_YAML)],
)
def test_mistakes_have_their_line(package: Path, name: str, text: str, line: int, message: str) -> None:
    with pytest.raises(DocumentError) as caught:
        load(package, text, name)
    assert (caught.value.file, caught.value.line) == (str(package / "launch" / name), line)
    assert caught.value.message.startswith(message)
    assert "\n" not in str(caught.value)


def test_the_two_kinds_do_not_include_each_other(package: Path) -> None:
    put(package, XML, "bot.launch.xml")
    own = put(package, "include: [{file: bot.launch.xml}]\n", "own.yaml")
    with pytest.raises(DocumentError, match=r"own.yaml:1:18: .*bot.launch.xml is a launch file of ROS 2"):
        read_system(own)
    path = put(package, '<launch><include file="$(dirname)/own.yaml"/></launch>', "other.launch.xml")
    with pytest.raises(DocumentError, match=r"own.yaml:1: it is one of robolink's own launch files"):
        read_system(path)


def test_commands_take_them(package: Path, capsys: pytest.CaptureFixture[str]) -> None:
    put(package, XML, "bot.launch.xml")
    assert said(capsys, "bot", "bot.launch.xml", "-s")[1] == "word  The word. (default: hello; one of hello, ho)\n"
    assert main(["simulate", "bot", "bot.launch.xml", "--duration", "5"]) == 0
    assert "/g/in/said" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("text", "is_ros"),
    [
        ("launch:\n- arg: {}", True),
        ("# comment\n\n---\nlaunch:\n", True),
        ('"launch":\n', True),
        ("nodes: [{node: x}]\n", False),
        ("description: |\n  launch:\n", False),
        ("nodes:\n- node: x\nlaunch: y\n", False),
        ("", False),
    ],
)
def test_the_kind_of_a_yaml_file_shows_in_its_first_key(tmp_path: Path, text: str, is_ros: bool) -> None:
    file = tmp_path / "x.yaml"
    file.write_text(text)
    assert is_of_ros(file) is is_ros


def test_words_of_a_command_line() -> None:
    def words(text: str) -> list[str]:
        parts = [words_of(parse_substitution(text))]
        return ["".join(getattr(one, "text", "$") for one in each) for each in parts[0]]

    assert words("a 'b c' \"d e\"f $(var x) ''") == ["a", "b c", "d ef", "$", ""]
    assert words("$(var x)$(var y) p$(var x)q\\ r") == ["$$", "p$q", "r"]
    assert words("  ") == []
    with pytest.raises(ValueError, match="closing quotation"):
        words("'$(var x) b'")


@pytest.mark.slow
@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    st.recursive(
        st.sampled_from(
            ["<log message='x'/>", "<node pkg='a' exec='b'/>", "<arg name='$(' />", "<let/>", "<group/>", "&x;"]
        ),
        lambda inner: st.lists(inner, max_size=3).map(lambda each: f"<group>{''.join(each)}</group>"),
        max_leaves=8,
    )
)
def test_any_xml_is_read_or_refused(package: Path, body: str) -> None:
    with contextlib.suppress(DocumentError):
        assert load(package, f"<launch>{body}</launch>", "bot.launch.xml").entries == []
