"""ROS arguments: what is read from a command line, what is left for the program, and what is refused."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.arguments.command_line import (
    Arguments,
    InvalidROSArgsError,
    UnknownROSArgsError,
    parse_arguments,
    remove_ros_args,
)
from robolink.arguments.remapping import RemapKind, resolve_name
from robolink.exceptions import RobolinkError
from robolink.logging import LoggingSeverity


def ros(line: str) -> Arguments:
    """Parse what stands behind `--ros-args`."""
    return parse_arguments(["--ros-args", *_words(line)])


def _words(line: str) -> list[str]:
    return line.split()


def test_nothing_said_changes_nothing() -> None:
    arguments = parse_arguments(["program", "-r", "a:=b", "--", "x"])
    assert arguments == Arguments(unparsed=("program", "-r", "a:=b", "--", "x"))
    assert arguments.node_name("talker") == "talker"
    assert arguments.namespace("/ns", "talker") == "/ns"
    assert resolve_name(arguments.remap_rules, RemapKind.TOPIC, "/scan", "talker", "/ns") == "/scan"
    assert resolve_name(arguments.remap_rules, RemapKind.SERVICE, "/add", "talker", "/ns") == "/add"
    assert arguments.overrides_for("/ns/talker") == {}
    assert (arguments.rosout_logs, arguments.stdout_logs, arguments.enclave) == (None, None, None)


def test_ros_arguments_end_at_two_dashes_and_may_come_again() -> None:
    args = _words("prog -d --ros-args -r __ns:=/foo -- --baz -- --ros-args --ros-args -r __node:=n")
    arguments = parse_arguments(args)
    assert arguments.unparsed == ("prog", "-d", "--baz", "--")
    assert remove_ros_args(args) == list(arguments.unparsed)
    assert arguments.namespace("/", "x") == "/foo"
    assert arguments.node_name("x") == "n"


def test_topics_and_services_are_remapped() -> None:
    rules = ros("-r scan:=lidar/scan --remap rosservice://~/reset:=/reset -r other:odom:=/odom").remap_rules
    assert resolve_name(rules, RemapKind.TOPIC, "/ns/scan", "talker", "/ns") == "/ns/lidar/scan"
    assert resolve_name(rules, RemapKind.SERVICE, "/ns/talker/reset", "talker", "/ns") == "/reset"
    assert resolve_name(rules, RemapKind.TOPIC, "/ns/talker/reset", "talker", "/ns") == "/ns/talker/reset"
    assert resolve_name(rules, RemapKind.TOPIC, "/ns/odom", "talker", "/ns") == "/ns/odom"
    assert resolve_name(rules, RemapKind.TOPIC, "/ns/odom", "other", "/ns") == "/odom"


def test_parameters_are_for_all_nodes_or_for_one() -> None:
    arguments = ros("-p speed:=0.5 --param talker:count:=3 -p arm.joints:=[1,2] -p speed:=0.7")
    assert arguments.overrides_for("/listener") == {"speed": 0.7, "arm.joints": [1, 2]}
    assert arguments.overrides_for("/talker") == {"speed": 0.7, "arm.joints": [1, 2], "count": 3}
    assert "count" not in arguments.overrides_for("/ns/talker")


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        ("-p n:a:=1 -p b:=2 -p n:b:=3", {"a": 1, "b": 2}),  # the pattern /n came before /**
        ("-p b:=2 -p n:b:=3", {"b": 3}),
        ("-p n:b:=3 -p n:b:=4", {"b": 4}),
    ],
)
def test_of_several_patterns_the_one_that_came_first_is_overridden(words: str, expected: dict[str, object]) -> None:
    assert parse_arguments(["--ros-args", *words.split()]).overrides_for("/n") == expected


def test_a_files_section_for_a_node_wins_over_a_later_value_for_all(tmp_path: Path) -> None:
    file = tmp_path / "params.yaml"
    file.write_text("/**: {ros__parameters: {x: 1, y: 1}}\nn: {ros__parameters: {x: 2}}\n")
    words = ["--ros-args", "--params-file", str(file), "-p", "x:=3", "-p", "y:=3"]
    assert parse_arguments(words).overrides_for("/n") == {"x": 2, "y": 3}
    assert parse_arguments(words).overrides_for("/m") == {"x": 3, "y": 3}


def test_errors_are_those_of_rclpy_and_value_errors() -> None:
    with pytest.raises(UnknownROSArgsError) as unknown:
        parse_arguments(["--ros-args", "--nonsense"])
    with pytest.raises(InvalidROSArgsError) as invalid:
        parse_arguments(["--ros-args", "-p", "a"])
    for error in (unknown.value, invalid.value):
        assert isinstance(error, RuntimeError)
        assert isinstance(error, ValueError)


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("1", 1),
        ("1.0", 1.0),
        ("true", True),
        ("'1'", "1"),
        ("[1,2]", [1, 2]),
        ("[1.0, 2.5]", [1.0, 2.5]),
        ("0x1F", 31),
        ("-.inf", float("-inf")),
        ("a:=b", "a:=b"),
        ("", None),
    ],
)
def test_a_parameter_value_is_yaml(text: str, value: object) -> None:
    args = ["--ros-args", "-p", f"x:={text}"]
    if value is None:
        with pytest.raises(InvalidROSArgsError, match="no value"):
            parse_arguments(args)
    else:
        found = parse_arguments(args).overrides_for("/n")["x"]
        assert (found, type(found)) == (value, type(value))


def test_later_arguments_win_over_earlier_ones_whether_files_or_values(tmp_path: Path) -> None:
    file = tmp_path / "params.yaml"
    file.write_text("/**: {ros__parameters: {a: 1, b: 1, c: 1}}\ntalker: {ros__parameters: {c: 2}}\n")
    arguments = ros(f"-p a:=0 --params-file {file} -p b:=0")
    assert arguments.overrides_for("/talker") == {"a": 1, "b": 0, "c": 2}
    assert arguments.overrides_for("/ns/talker") == {"a": 1, "b": 0, "c": 1}


def test_log_settings_are_read() -> None:
    arguments = ros("--log-level warn --log-level my.node:=DEBUG --disable-rosout-logs --enable-stdout-logs")
    assert arguments.log_levels == (("", LoggingSeverity.WARN), ("my.node", LoggingSeverity.DEBUG))
    assert (arguments.rosout_logs, arguments.stdout_logs, arguments.external_lib_logs) == (False, True, None)
    other = ros("-e /a --enclave /b --log-file-name f --log-config-file c --disable-external-lib-logs")
    assert (other.enclave, other.log_file_name, other.log_config_file) == ("/b", "f", "c")
    assert other.external_lib_logs is False


def test_a_nodes_own_arguments_go_over_the_programs() -> None:
    program = ros("-r a:=b -r c:=d -p x:=1 -p y:=1 -e /e --disable-rosout-logs -- prog")
    both = ros("-r a:=z -p x:=2 --enable-rosout-logs").over(program)
    assert resolve_name(both.remap_rules, RemapKind.TOPIC, "/a", "n", "/") == "/z"
    assert resolve_name(both.remap_rules, RemapKind.TOPIC, "/c", "n", "/") == "/d"
    assert both.overrides_for("/n") == {"x": 2, "y": 1}
    assert (both.enclave, both.rosout_logs, both.stdout_logs, both.unparsed) == ("/e", True, None, ())


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("-r not-a-remap", "Failed to parse ROS arguments: '-r not-a-remap': expected from:=to"),
        ("-r", "-r must be followed by from:=to"),
        ("-r a:=b?", r"'-r a:=b\?': topic name 'b\?' must not contain"),
        ("-p x", "expected name:=value"),
        ("-p :=1", "expected name:=value"),
        ("-p *:x:=1", "expected name:=value"),
        ("-p x:=[1,a]", "a list holds one type, got str after int"),
        ("-p x:=[1.5,2]", "a list holds one type, got int after float: write 2.0"),
        ("-p x:=[1,2.5]", "a list holds one type, got float after int: write 1.0"),
        ("-p x:={a:1}", "cannot be a mapping"),
        ("-p x:=[1", "value:1:3: expected"),
        ("--param", "--param must be followed by name:=value"),
        ("--params-file /nowhere/x.yaml", "no file '.*x.yaml'"),
        ("--log-level dbug", r"no log severity named 'dbug' \(did you mean 'DEBUG'\?\)"),
        ("--log-level :=debug", "expected LEVEL or logger:=LEVEL"),
        ("--log-level", "must be followed by LEVEL"),
    ],
)
def test_an_argument_that_cannot_be_read_is_named_with_the_reason(line: str, message: str) -> None:
    with pytest.raises(InvalidROSArgsError, match=message) as caught:
        ros(line)
    assert "\n" not in str(caught.value)
    assert isinstance(caught.value, RobolinkError)


def test_unknown_arguments_are_all_named() -> None:
    with pytest.raises(UnknownROSArgsError, match=r"\['--remapp', 'a:=b'\] \(did you mean '--remap'\?\)") as caught:
        ros("--remapp a:=b -r a:=b")
    assert caught.value.unknown_args == ["--remapp", "a:=b"]


def test_a_bad_parameter_file_is_named_with_line_and_column(tmp_path: Path) -> None:
    file = tmp_path / "params.yaml"
    file.write_text("talker:\n  ros__parameters:\n    gains: [1, x]\n")
    with pytest.raises(InvalidROSArgsError, match=r"params.yaml:3:16: gains: a list holds one type"):
        ros(f"--params-file {file}")


def test_an_argument_that_is_no_text_is_refused_as_rclpy_does() -> None:
    with pytest.raises(UnicodeEncodeError):
        parse_arguments(["my-node.py", "Ragnar\udcc3\udcb6k"])


words = st.one_of(
    st.sampled_from(_words("--ros-args -- -r -p --params-file --log-level -e --disable-rosout-logs a:=b x:=[1] debug")),
    st.text(alphabet="ab:=/-[]{}&*!'\"#%\n ,.1", max_size=8),
)


@given(st.lists(words, max_size=10))
def test_any_command_line_is_read_or_refused_with_a_documented_error(args: list[str]) -> None:
    with suppress(InvalidROSArgsError, UnknownROSArgsError):
        arguments = parse_arguments(args)
        assert list(arguments.unparsed) == remove_ros_args(args)
        assert isinstance(arguments.overrides_for("/a/b"), dict)


def test_a_launcher_gives_a_parameter_to_a_node_by_its_full_name() -> None:
    given = ros("--child-param /r1/local_costmap/local_costmap:width:=3 -p driver:width:=4")
    assert given.overrides_for("/r1/local_costmap/local_costmap") == {"width": 3}
    assert given.overrides_for("/driver") == {"width": 4}
    assert given.overrides_for("/r1/controller_server") == {}
    for refused in ("-p /driver:width:=4", "--child-param driver:width:=4", "--child-param /driver:=4"):
        with pytest.raises(InvalidROSArgsError):
            ros(refused)
