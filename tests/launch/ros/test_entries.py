"""Actions of ROS 2's launch files become the nodes and commands that robolink starts."""

from __future__ import annotations

import sys
from pathlib import Path
from types import SimpleNamespace

import pytest

from robolink.launch.entry import Entry, Respawn
from robolink.launch.planning import as_process, processes
from robolink.launch.ros import entries
from robolink.supervisor.policy import NO_LIMIT
from robolink.system.processes import own_command
from tests.support.ros_launch import FIRST, only, read, write


def words(entry: Entry) -> list[str]:
    """The command line, behind the words that start a robolink."""
    (launched,) = processes([entry])
    argv = as_process(launched).argv
    own = list(own_command())
    return list(argv[len(own) :]) if list(argv[: len(own)]) == own else list(argv)


def test_modules_of_launch_need_no_import_of_their_own(package: Path) -> None:
    system = read(
        package,
        """
        import launch
        assert launch.substitution.Substitution is launch.Substitution
        def generate_launch_description():
            return LaunchDescription([launch.actions.log_info.LogInfo(msg="x")])
        """,
    )
    assert system.notes == ["x"]


def test_a_node_has_all_that_its_action_says(package: Path) -> None:
    entry = only(
        package,
        """
        DeclareLaunchArgument("word", default_value="hello"),
        SetEnvironmentVariable("LEVEL", ["3", "4"]),
        Node(package="bot", executable=["talk", "er"], name="speaker", namespace="left", output="screen",
             parameters=[{"word": LaunchConfiguration("word"), "arm": {"gain": [1, 2.5]}, "n": 3}],
             remappings=[("chatter", ["say/", LaunchConfiguration("word")])], emulate_tty=True,
             arguments=["--fast", 3], ros_arguments=["--log-level", "debug"], sigterm_timeout="3"),
        """,
        word="ho",
    )
    assert entry.name == "left/speaker"
    assert entry.source is not None
    assert (entry.source.module, entry.source.attribute) == ("bot.talker", "main")
    ours, _, theirs = " ".join(words(entry)[2:]).partition(" -r ")
    assert ours == "-- --ros-args --log-level debug -- --fast 3 --ros-args"
    values = '-p word:="ho" -p arm.gain:=[1.0, 2.5] -p n:=3'
    assert theirs == f"__node:=speaker -r __ns:=/left {values} -r chatter:=say/ho"
    assert entry.node.env == {"LEVEL": "34"}
    assert (entry.node.on_exit, entry.node.respawn.when) == ("ignore", "never")


def test_a_scope_ends_with_its_group(package: Path) -> None:
    system = read(
        package,
        """
        GroupAction([
            PushRosNamespace("a"), SetRemap("chatter", "/one"), SetParameter("word", "x"),
            SetEnvironmentVariable("E", "1"), SetLaunchConfiguration("where", "in"),
            Node(package="bot", executable="talker", namespace="b", remappings=[("chatter", "/two"), ("x", "y")],
                 parameters=[{"period": 2.0}]),
            GroupAction([PushROSNamespace("/c"), Node(package="bot", executable="talker")], scoped=True),
        ]),
        Node(package="bot", executable="talker", name="last",
             parameters=[{"word": LaunchConfiguration("where", default="out")}]),
        """,
    )
    first, second, last = system.entries
    assert (first.name, second.name, last.name) == ("a/b/talker", "c/talker", "last")
    assert first.node.remappings == {"chatter": "/one", "x": "y"}
    assert first.node.parameters == {"word": "x", "period": 2.0}
    assert (set(first.wide), first.node.env) == ({"word"}, {"E": "1"})
    assert (last.node.parameters, last.node.remappings, last.node.env) == ({"word": "out"}, {}, {})


@pytest.mark.parametrize(("given", "names"), [("true", ["talker"]), ("0", ["once"]), ("False", ["once"])])
def test_conditions_decide(package: Path, given: str, names: list[str]) -> None:
    system = read(
        package,
        """
        DeclareLaunchArgument("talk"),
        Node(package="bot", executable="talker", condition=IfCondition(LaunchConfiguration("talk"))),
        Node(package="bot", executable="once", condition=UnlessCondition(LaunchConfiguration("talk"))),
        """,
        talk=given,
    )
    assert [each.name for each in system.entries] == names


def test_files_of_parameters_count_by_their_sections(package: Path) -> None:
    (package / "config" / "a.yaml").write_text(
        "/**: {ros__parameters: {period: 2.0}}\n/ns/one: {ros__parameters: {word: one}}\n"
        "talker: {ros__parameters: {word: nobody}}\n"
    )
    (package / "config" / "b.yaml").write_text("/**: {ros__parameters: {word: $(var word)}}\n")
    one, two, unnamed = read(
        package,
        """
        SetLaunchConfiguration("word", "put in"),
        Node(package="bot", executable="talker", name="one", namespace="ns",
             parameters=[{"word": "first", "period": 1.0}, FindPackageShare("bot") / "config" / "a.yaml"]),
        Node(package="bot", executable="talker", name="two",
             parameters=[ParameterFile([FindPackageShare("bot"), "/config/b.yaml"], allow_substs=True)]),
        Node(package="bot", executable="talker",
             parameters=[{"word": "w"}, get_package_share_directory("bot") + "/config/a.yaml", {"period": 3.0}]),
        """,
    ).entries
    assert one.node.parameters == {"word": "one", "period": 2.0}
    assert two.node.parameters == {"word": "put in"}
    assert unnamed.node.parameters == {"period": 3.0}
    file = str(package / "config" / "a.yaml")
    assert unnamed.node.args == ["--ros-args", "-p", 'word:="w"', "--params-file", file, "--"]
    assert package / "config" / "a.yaml" in unnamed.files
    assert (set(one.wide), set(two.wide)) == ({"period"}, {"word"})


def test_a_section_of_a_file_that_no_node_takes_is_told_of(package: Path) -> None:
    file = package / "config" / "a.yaml"
    file.write_text("/**: {ros__parameters: {word: x}}\nsepaker: {ros__parameters: {word: y}}\n")
    body = f'Node(package="bot", executable="talker", name="speaker", parameters=[{str(file)!r}]),'
    line = "a.yaml: 'sepaker' is not the name of a node that gets it (did you mean 'speaker'?)"
    assert read(package, body).notes == [line]
    assert read(package, body.replace("speaker", "other")).notes == []


def test_values_have_the_types_that_are_asked_for(package: Path) -> None:
    entry = only(
        package,
        """
        Node(package="bot", executable="talker", parameters=[{
            "text": ParameterValue("12", value_type=str), "number": TextSubstitution(text="12"),
            "real": ParameterValue(LaunchConfiguration("x", default="1"), value_type=float),
            "list": ParameterValue(TextSubstitution(text="[1, 2]"), value_type=list[int]), "plain": "12",
            "flag": ["tr", TextSubstitution(text="ue")],
            ("joined", "_name"): True}]),
        """,
    )
    assert entry.node.parameters == {
        "text": "12", "number": 12, "real": 1.0, "list": [1, 2], "plain": "12", "flag": True, "joined_name": True,
    }  # fmt: skip


def test_a_command_runs_as_it_is(package: Path) -> None:
    entry = only(
        package,
        f"""
        ExecuteProcess(cmd=[{sys.executable!r}, "-c", ["print(", "1", ")"]], cwd=ThisLaunchFileDir(), name="py",
                       additional_env={{"A": "b"}}, shell=False, on_exit=Shutdown(reason="done")),
        """,
    )
    assert words(entry) == [sys.executable, "-c", "print(1)"]
    assert (entry.name, entry.source, entry.node.env) == ("py", None, {"A": "b"})
    assert entry.node.cwd == str(package / "launch")
    assert entry.node.on_exit == "shutdown"
    assert as_process(processes([entry])[0]).cwd == entry.node.cwd


def test_ros2_is_robolink(package: Path) -> None:
    entry = only(package, 'ExecuteProcess(cmd=["ros2 topic list"], output="both")')
    assert words(entry) == ["topic", "list"]
    entry = only(package, 'ExecuteProcess(cmd=["ros2", "bag", "record", "-a"], shell=True)')
    if sys.platform != "win32":
        assert entry.name == "ros2"
        assert words(entry)[-1].endswith(' "$@"; }\nros2 bag record -a')


@pytest.mark.parametrize("command", ["'python3', 'FILE'", "'python3', '-u', 'FILE'", "'FILE'"])
def test_python_files_find_rclpy(command: str, package: Path) -> None:
    script = package / "restamp.py"
    script.write_text("import rclpy\n")
    entry = only(package, f"ExecuteProcess(cmd=[{command}, '--fast'])".replace("FILE", script.as_posix()))
    assert words(entry) == ["run", str(script), "--", "--fast"]
    assert entry.name == "restamp"


def test_other_commands_of_python_stay_as_they_are(package: Path) -> None:
    assert words(only(package, 'ExecuteProcess(cmd=["python3", "-m", "http.server"])'))[1:] == ["-m", "http.server"]


def test_respawn_is_without_limit(package: Path) -> None:
    forever, thrice, never = read(
        package,
        """
        Node(package="bot", executable="talker", name="a", respawn=True, respawn_delay=2.0),
        Node(package="bot", executable="talker", name="b", respawn="true", respawn_max_retries=3),
        Node(package="bot", executable="talker", name="c", respawn=False),
        """,
    ).entries
    assert forever.node.respawn == Respawn("always", 2.0, 2.0, NO_LIMIT, NO_LIMIT)
    assert thrice.node.respawn == Respawn("always", 0.1, 0.1, 3, NO_LIMIT)  # at once would be for ever at one moment
    assert never.node.respawn.when == "never"


def test_names_that_several_have_get_a_number(package: Path) -> None:
    node = 'Node(package="bot", executable="talker"),\n'
    assert [each.name for each in read(package, node * 3).entries] == ["talker", "talker-2", "talker-3"]


def test_a_file_includes_others(package: Path) -> None:
    write(
        package,
        """
        DeclareLaunchArgument("who", default_value="nobody"),
        LogInfo(msg=[ThisLaunchFileDir(), " ", LaunchConfiguration("who")]),
        Node(package="bot", executable="talker", name=LaunchConfiguration("who")),
        """,
        "part.launch.py",
    )
    system = read(
        package,
        """
        IncludeLaunchDescription(PythonLaunchDescriptionSource([ThisLaunchFileDir(), "/part.launch.py"]),
                                 launch_arguments={"who": "one"}.items()),
        GroupAction([PushRosNamespace("g"), IncludeLaunchDescription(
            PathJoinSubstitution([FindPackageShare("bot"), "launch", "part.launch.py"]),
            launch_arguments=[("who", "two")])]),
        OpaqueFunction(function=lambda context: [LogInfo(msg=str(sorted(context.launch_configurations)))]),
        """,
    )
    assert [each.name for each in system.entries] == ["one", "g/two"]
    assert system.notes == [f"{package}/launch one", f"{package}/launch two", "['who']"]
    assert system.entries[0].files == {package / "launch" / name for name in ("bot.launch.py", "part.launch.py")}


def test_loops_repeat_a_function(package: Path) -> None:
    system = read(
        package,
        """
        def made(name, x=0):
            return [Node(package="bot", executable="talker", name=name, parameters=[{"period": float(x)}])]

        def generate_launch_description():
            return LaunchDescription([
                ForEach(LaunchConfiguration("robots", default="{name: ada, x: 1}; {name: bob}"), function=made),
                ForLoop("2", function=lambda i: made(f"n{i}")), ForLoop(" +0_1 ", function=lambda i: made("one"))])
        """,
    )
    assert [each.name for each in system.entries] == ["ada", "bob", "n0", "n1", "one"]
    assert system.entries[0].node.parameters == {"period": 1.0}


@pytest.mark.processes
def test_functions_and_expressions_are_evaluated(package: Path) -> None:
    system = read(
        package,
        """
        def start(context, count, name):
            return [Node(package="bot", executable="talker", name=f"{name}{i}") for i in range(count)]

        def generate_launch_description():
            made = LaunchDescription()
            made.add_action(DeclareLaunchArgument("n", default_value="2"))
            made.add_action(OpaqueFunction(function=start, args=[2], kwargs={"name": "t"}))
            made.add_action(LogInfo(msg=PythonExpression([LaunchConfiguration("n"), " * 3 if 'a' == 'a' else 0"])))
            made.add_action(LogInfo(msg=["x", EnvironmentVariable("NOT_SET_AT_ALL", default_value="y")]))
            made.add_action(LogInfo(msg=Command(["echo ", "out"])))
            return made
        """,
    )
    assert [each.name for each in system.entries] == ["t0", "t1"]
    assert [each.strip() for each in system.notes] == ["6", "xy", "out"]


def test_a_package_finds_its_own_modules(package: Path) -> None:
    (package / "bot" / "helper.py").write_text("NAME = 'helped'\n")
    before = list(sys.path)
    entry = only(
        package,
        """
        def generate_launch_description():
            from bot.helper import NAME
            return LaunchDescription([Node(package="bot", executable="talker", name=NAME)])
        """,
    )
    assert entry.name == "helped"
    assert sys.path == before


def test_a_terminal_that_is_not_there_is_this_one(package: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", str(package))
    node = 'Node(package="bot", executable="talker", name="{}", prefix="{}"),\n'
    system = read(package, node.format("a", "xterm -e") + node.format("b", "gdb -ex run --args"))
    assert [each.node.interactive for each in system.entries] == [True, False]
    assert system.notes == [
        f"bot.launch.py:{FIRST + 2}: 'xterm' is not installed: the keyboard of this terminal is read instead",
        f"bot.launch.py:{FIRST + 3}: the prefix 'gdb' is left out: no such program is on the PATH",
    ]


def test_a_prefix_stands_in_front(package: Path) -> None:
    entry = only(
        package, f'Node(package="bot", executable="talker", prefix="{Path(sys.executable).as_posix()} -X dev")'
    )
    (launched,) = processes([entry])
    assert as_process(launched).argv[:4] == [Path(sys.executable).as_posix(), "-X", "dev", own_command()[0]]


def test_a_rewritten_file_gives_the_parameters_of_a_node(package: Path) -> None:
    (package / "config" / "a.yaml").write_text("/**: {ros__parameters: {word: one, period: 2.0}}")
    entry = only(
        package,
        """
        Node(package="bot", executable="talker", name="one", parameters=[ParameterFile(
            __import__("nav2_common.launch", fromlist=["launch"]).RewrittenYaml(
                source_file=get_package_share_directory("bot") + "/config/a.yaml", root_key="",
                param_rewrites={"period": LaunchConfiguration("period")}, convert_types=True),
            allow_substs=True)]),
        """,
        period="0.5",
    )
    assert entry.node.parameters == {"word": "one", "period": 0.5}


def test_old_names_of_arguments_are_taken_and_told_once(package: Path) -> None:
    system = read(
        package,
        """
        Node(package="bot", node_executable="talker", node_name="a", node_namespace="old"),
        Node(package="bot", node_executable="talker", node_name="b", node_namespace="old"),
        ComposableNodeContainer(node_name="c", node_namespace="", package="rclcpp_components",
            node_executable="component_container", composable_node_descriptions=[
                ComposableNode(package="bot", node_plugin="bot::Talker", node_name="d")]),
        """,
    )
    assert [each.name for each in system.entries] == ["old/a", "old/b", "d"]
    line = (
        "old names, which ROS 2 refuses since Galactic: node_executable, node_name, node_namespace; write executable, "
    )
    assert [each.partition(": ")[2] for each in system.notes] == [
        f"{line}name, namespace",
        "old names, which ROS 2 refuses since Galactic: node_name, node_plugin; write name, plugin",
    ]
    assert system.notes[0].startswith(f"bot.launch.py:{FIRST + 2}: ")


def test_a_line_for_the_shell_of_windows_keeps_its_quotes(package: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(entries, "sys", SimpleNamespace(platform="win32"))
    entry = only(package, """ExecuteProcess(cmd=['other service call /spawn "{x: 2}"'], shell=True)""")
    assert entry.node.run == ["cmd", "/d", "/s", "/c", 'other service call /spawn "{x: 2}"']
