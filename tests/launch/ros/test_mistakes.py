"""Mistakes in ROS 2's launch files are one line, at the line of the user's own file."""

from __future__ import annotations

import contextlib
from importlib.metadata import version
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.exceptions import DocumentError
from robolink.launch.ros.launch import LaunchContext, LaunchIntrospector
from robolink.launch.ros.launch.bases import LaunchError
from robolink.launch.ros.launch.frontend.parse_substitution import parse_substitution
from robolink.launch.ros.launch.sources import PythonLaunchDescriptionSource
from robolink.launch.ros.launch.utilities import perform_substitutions
from robolink.launch.ros.surroundings import surroundings
from robolink.launch.system import arguments_of, read_system
from tests.support.ros_launch import FIRST, read, write

BOUNCY = "that is ROS 2 before Bouncy (2018): Node(respawn=True, on_exit=...) is what it has now"
BODIES = [
    ("raise KeyError('x')", 1, "KeyError: 'x'"),
    (
        "import os; os.environ['NOT_SET_AT_ALL']",
        1,
        "the environment has no 'NOT_SET_AT_ALL', which this file needs: set it, as by export NOT_SET_AT_ALL=VALUE",
    ),
    ("import numpi", 1, "ModuleNotFoundError: No module named 'numpi' (did you mean 'numpy'?)"),
    ("import foo; foo.x + 1; open(foo.path)", 1, "it needs the Python module foo, which is not here"),
    (
        "from launch_ros.actions import Nod",
        1,
        f"robolink {version('robolink')} has no launch_ros.actions.Nod (did you mean 'Node'?)",
    ),
    ("import sys; sys.exit(3)", 1, "it ends the program: sys.exit(3)"),
    ("raise type('Stop', (KeyboardInterrupt,), {})('now')", 1, "Stop: now"),
    ("raise type('Stop', (BaseException,), {})", 1, "Stop"),
    ("raise GeneratorExit", 1, "GeneratorExit"),
    ("open(get_package_share_directory('nobody') + '/x')", 1, "package nobody is not here, and its x is needed"),
    (
        "from launch.exit_handler import restart_exit_handler",
        1,
        f"robolink {version('robolink')} has no launch.exit_handler; {BOUNCY}",
    ),
    ("return [1]", None, "generate_launch_description() returned list, and a LaunchDescription was expected"),
    ("pass", None, "generate_launch_description() returned NoneType, and a LaunchDescription was expected"),
    ("return LaunchDescription(]", 1, "closing parenthesis ']' does not match opening parenthesis '('"),
]
ACTIONS = [
    ("Node(package='bot', executable='talkr')", "no executable named 'talkr' in package bot (did you mean 'talker'?)"),
    ("Node(package='bott', executable='x')", "no package named 'bott' (did you mean 'bot'?)"),
    ("Node(executable='talker', paramters=[])", "Node has no argument 'paramters' (did you mean 'parameters'?)"),
    ("Node(executable='talker', outptu='screen')", "Node has no argument 'outptu' (did you mean 'output'?)"),
    ("Node(executable='x', node_executable='y')", "Node has executable and node_executable, which is its old"),
    ("LifecycleNode(executable='talker', node_name='x')", "LifecycleNode needs namespace=..."),
    ("ComposableNodeContainer(executable='x')", "ComposableNodeContainer needs name=..."),
    ("ComposableNode(package='x')", "ComposableNode needs plugin=..."),
    ("ComposableNode(plugin='x')", "ComposableNode needs 'package'"),
    ("ComposableNode(package='x', plugn='x')", "ComposableNode has no argument 'plugn' (did you mean 'plugin'?)"),
    ("GroupAction([], scopd=1)", "GroupAction has no argument 'scopd' (did you mean 'scoped'?)"),
    (
        "Node(package='bot', executable='talker', remappings=[('a b', 'c')])",
        "remapping 'a b' to 'c': topic name 'a b' must not contain characters other than",
    ),
    (
        "GroupAction([SetRemap('', ''), Node(package='bot', executable='talker')])",
        "remapping '' to '': topic name '' must not be empty",
    ),
    ("LogInfo()", "LogInfo needs 'msg'"),
    ("LogInfo(msg=LaunchConfiguration('a', defualt=1))", "LaunchConfiguration has no argument 'defualt' (did you mean"),
    ("LogInfo(msg=LaunchConfiguration('a'))", "no launch argument is called 'a'"),
    ("LogInfo(msg=PythonExpression(['1+']))", "the expression '1+' fails: SyntaxError: "),
    ("LogInfo(msg=3)", "expected a text or a substitution, got int (3)"),
    ("DeclareLaunchArgument('must')", "'must' must be given: must:=VALUE"),
    ("DeclareLaunchArgument('a', default_value='x', choices=['y', 'z'])", "'a': the default 'x' is not in"),
    ("LogInfo(msg='', condition=IfCondition('maybe'))", "expected true, false, 1 or 0, got 'maybe'"),
    ("IncludeLaunchDescription(ThisLaunchFile())", "a launch file cannot include itself: bot.launch.py -> bot."),
    ("IncludeLaunchDescription([ThisLaunchFileDir(), '/b.launch.py'])", "there is no launch file {launch}/b.launch.py"),
    ("OpaqueFunction(function=lambda context: ['x'])", "an action is expected, got str"),
    ("OpaqueFunction(function=lambda context: 1 / 0)", "ZeroDivisionError: division by zero"),
    ("OpaqueFunction(function=lambda context: (_ for _ in ()).throw(GeneratorExit('x')))", "GeneratorExit: x"),
    ("ForLoop('x', function=lambda i: [])", "the length of a loop is a number from 0 on, got 'x'"),
    ("ForLoop(20000, function=lambda i: [])", "more than 10,000 repetitions"),
    ("ForLoop('0000000020000', function=lambda i: [])", "more than 10,000 repetitions"),
    ("ForLoop('2_0_000', function=lambda i: [])", "more than 10,000 repetitions"),
    ("ForLoop('٢٠٠٠٠', function=lambda i: [])", "more than 10,000 repetitions"),
    ("ForLoop('²', function=lambda i: [])", "the length of a loop is a number from 0 on, got '²'"),
    ("ForLoop('-5', function=lambda i: [])", "the length of a loop is a number from 0 on, got one below"),
    ("ForLoop('9' * 999999, function=lambda i: [])", "the length of a loop is a number from 0 on, got '999"),
    (
        "EmitEvent(event=events.process.SignalProcess(signal_number='SIGINNT', process_matcher=print))",
        "no signal here is 'SIGINNT' (did you mean 'SIGINT'?)",
    ),
    (
        "EmitEvent(event=events.process.SignalProcess(signal_number='nope', process_matcher=print))",
        "no signal here is 'nope': signals are such as SIGINT or SIGTERM",
    ),
    (
        "EmitEvent(event=events.process.SignalProcess(signal_number=999, process_matcher=print))",
        "no signal here is 999: signals are such as SIGINT or SIGTERM",
    ),
    ("ForEach('{a: 1', function=print)", "'{{a: 1' is not YAML: "),
    ("ForEach('a', function=print)", "a mapping such as {{name: ada}} is expected, got 'a'"),
    ("ExecuteProcess(cmd='ls -l')", "cmd is a list of words, such as ['ls', '-l'], got the text 'ls -l'"),
    ("Node(package='bot', executable='talker', name='a b')", "'a b' must not contain characters other than a-z"),
    ("Node(package='bot', executable='talker', namespace='a b')", "'/a b' must not contain characters other than"),
    ("Node(package='bot', executable='talker', parameters={})", "parameters are a list, as in [{{}}]"),
    ("Node(package='bot', executable='talker', parameters=[{'x': None}])", "parameter 'x': a parameter is a plain"),
    ("Node(package='bot', executable='talker', parameters=[{'x': 2**70}])", "parameter 'x': 1180591620717411303424 is"),
    ("Node(package='bot', executable='talker', remappings=['x'])", "a remapping is a pair of two names, got 'x'"),
    ("Node(package='bot', executable='talker', respawn=True, respawn_delay='x')", "respawn_delay is a number of"),
]  # fmt: skip


@pytest.mark.parametrize(("body", "line", "text"), BODIES)
def test_of_the_file(package: Path, body: str, line: int | None, text: str) -> None:
    with pytest.raises(DocumentError) as caught:
        read(package, f"def generate_launch_description():\n    {body}")
    assert caught.value.file == str(package / "launch" / "bot.launch.py")
    assert caught.value.line == (0 if line is None else FIRST + line)
    assert caught.value.message == text


@pytest.mark.parametrize(("action", "text"), ACTIONS)
def test_of_an_action(package: Path, action: str, text: str) -> None:
    with pytest.raises(DocumentError) as caught:
        read(package, f"LogInfo(msg='fine'),\n{action},")
    assert (caught.value.file, caught.value.line) == (str(package / "launch" / "bot.launch.py"), FIRST + 3)
    assert caught.value.message.startswith(text.format(launch=package / "launch"))
    assert "\n" not in str(caught.value)


def test_an_interrupt_of_the_user_passes(package: Path) -> None:
    with pytest.raises(KeyboardInterrupt):
        read(package, "OpaqueFunction(function=lambda context: (_ for _ in ()).throw(KeyboardInterrupt)),")


def test_a_file_of_before_2018_is_told_what_replaces_it(package: Path) -> None:
    path = package / "launch" / "old.launch.py"
    path.write_text("def launch(launch_descriptor, argv):\n    return launch_descriptor\n")
    with pytest.raises(DocumentError, match=r"launch\(launch_descriptor, argv\) is of ROS 2 before Bouncy \(2018\)"):
        read_system(path, {})


def test_what_never_ends(package: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("robolink.launch.ros.visit.MOST_VISITED", 1_000)
    endless = """
    def again(context):
        return [OpaqueFunction(function=again)]

    def generate_launch_description():
        return LaunchDescription([OpaqueFunction(function=again)])
    """
    with pytest.raises(DocumentError, match=r"bot.launch.py:\d+: it never ends: more than 1,000 actions"):
        read(package, endless)
    with pytest.raises(DocumentError, match=r"bot.launch.py:\d+: it never ends: a function or a substitution calls"):
        read(package, endless.replace("[OpaqueFunction(function=again)]\n\n", "again(context)\n\n"))
    write(package, "IncludeLaunchDescription([ThisLaunchFileDir(), '/bot.launch.py'])", "other.launch.py")
    with pytest.raises(DocumentError, match=r"include itself: bot.launch.py -> other.launch.py -> bot.launch.py"):
        read(package, "IncludeLaunchDescription([ThisLaunchFileDir(), '/other.launch.py'])")
    with pytest.raises(DocumentError, match="with each substitution performed this has more than 1,000,000"):
        read(package, "LogInfo(msg=PythonExpression(\"'x' * 1000001\"))")


CIRCLES = {
    "own folder": "IncludeLaunchDescription([ThisLaunchFileDir(), '/bot.launch.py']),",
    "own path": "IncludeLaunchDescription(__file__),",
    "another": "GroupAction([IncludeLaunchDescription([ThisLaunchFileDir(), '/other.launch.py'])]),",
}


@pytest.mark.parametrize("way", CIRCLES)
def test_a_circle_has_no_arguments_that_anybody_could_list(package: Path, way: str) -> None:
    names = (
        "bot.launch.py -> other.launch.py -> bot.launch.py" if way == "another" else "bot.launch.py -> bot.launch.py"
    )
    write(package, CIRCLES["own folder"], "other.launch.py")
    path = write(package, CIRCLES[way])
    with pytest.raises(DocumentError, match=rf"launch.py:\d+: a launch file cannot include itself: {names}"):
        arguments_of(path)
    write(package, f"{CIRCLES[way]} DeclareLaunchArgument('speed'),")
    assert [each.name for each in arguments_of(path)] == ["speed"]
    write(package, "IncludeLaunchDescription(__file__, condition=IfCondition(LaunchConfiguration('again'))),")
    assert arguments_of(path) == []


def test_a_description_in_a_circle_can_be_asked_and_shown(package: Path) -> None:
    path = write(package, f"{CIRCLES['own path']} DeclareLaunchArgument('speed'),")
    with surroundings(None):
        description = PythonLaunchDescriptionSource(str(path)).get_launch_description(LaunchContext())
        assert [each.name for each in description.get_launch_arguments()] == ["speed"]
        assert LaunchIntrospector().format_launch_description(description).count("IncludeLaunchDescription") == 2


TEXTS = [
    ("plain", "plain"),
    ("$(var a)/$(var  'a' )", "1/1"),
    ("$(var none 'a b')", "a b"),
    ("$(var none $(var a))", "1"),
    (r"\$(var a)", "$(var a)"),
    ("$(eval '$(var a) + 1')", "2"),
    ("$(eval \"'x' + '$(var a)'\")", "x1"),
    ("$(env NOT_SET_AT_ALL d)", "d"),
    ("$(not $(eval 1==2))", "true"),
    ("$", "$"),
]
WRONG_TEXTS = [
    ("$(var", "'$(var' has no closing bracket"),
    ("$(vra x)", "no substitution is called 'vra' (did you mean 'var'?)"),
    ("$(var)", "$(var ...) takes 1 to 2 arguments, got 0: $(var)"),
    ("$()", "'$()' names no substitution"),
    ("$(var 'a)", "''a)' has no closing quote"),
    ("$(var " * 60, "substitutions are nested over 50 deep"),
]


@pytest.mark.parametrize(("text", "value"), TEXTS)
def test_substitutions_in_texts(text: str, value: str) -> None:
    context = LaunchContext()
    context.launch_configurations["a"] = "1"
    assert perform_substitutions(context, parse_substitution(text)) == value


@pytest.mark.parametrize(("text", "reason"), WRONG_TEXTS)
def test_wrong_substitutions_in_texts(text: str, reason: str) -> None:
    with pytest.raises(LaunchError) as caught:
        parse_substitution(text)
    assert str(caught.value) == reason


@given(st.text(alphabet="$()'\" \\avrenv-", max_size=60))
def test_any_text_is_read_or_refused(text: str) -> None:
    with contextlib.suppress(LaunchError):
        assert perform_substitutions(LaunchContext(), parse_substitution(text)) is not None
