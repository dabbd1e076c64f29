"""nav2_common.launch: parameter files are rewritten as launch files of Nav2 ask for it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.documents.yamlfile import parse, spell
from robolink.launch.ros.launch import LaunchContext
from robolink.launch.ros.launch.bases import LaunchError
from robolink.launch.ros.launch.conditions import IfCondition
from robolink.launch.ros.launch.substitutions import LaunchConfiguration
from robolink.launch.ros.nav2_common import (
    HasNodeParams,
    LaunchConfigAsBool,
    ParseMultiRobotPose,
    ReplaceString,
    RewrittenYaml,
)

SOURCE = """
amcl:
  ros__parameters:
    use_sim_time: false  # the robot's
    alpha1: 0.2
    scan_topic: SCAN
    plugins: [static, SCAN]
local_costmap:
  local_costmap:
    ros__parameters: {use_sim_time: false, width: 3, map: ""}
"""


@pytest.fixture
def source(tmp_path: Path) -> Path:
    file = tmp_path / "nav2_params.yaml"
    file.write_text(SOURCE)
    return file


def context(**configurations: str) -> LaunchContext:
    made = LaunchContext()
    made.launch_configurations.update(configurations)
    return made


def rewritten(source: Path, rewrites: dict[str, Any], made: LaunchContext | None = None, **options: Any) -> Any:
    """The content of the copy."""
    path = RewrittenYaml(str(source), rewrites, **options).perform(made or context())
    assert Path(path) != source
    assert source.read_text() == SOURCE
    return parse(Path(path).read_text())


def test_names_are_rewritten_wherever_they_stand(source: Path) -> None:
    made = context(use_sim_time="True")
    data = rewritten(source, {"use_sim_time": LaunchConfiguration("use_sim_time"), "unknown": "1"}, made)
    assert data["amcl"]["ros__parameters"]["use_sim_time"] is True
    assert data["local_costmap"]["local_costmap"]["ros__parameters"]["use_sim_time"] is True
    assert data["amcl"]["ros__parameters"]["alpha1"] == 0.2
    assert "unknown" not in spell(data)


@pytest.mark.parametrize(
    ("text", "convert", "value"),
    [
        ("7", True, 7),
        ("7.5", True, 7.5),
        ("map.yaml", True, "map.yaml"),
        ("7", False, "7"),
        ("FALSE", False, False),
        ("1e3", True, "1e3"),
        ("", True, ""),
    ],
)
def test_values_are_converted_if_that_is_wanted(source: Path, text: str, convert: bool, value: Any) -> None:
    data = rewritten(source, {"width": text}, convert_types=convert)
    found = data["local_costmap"]["local_costmap"]["ros__parameters"]["width"]
    assert (found, type(found)) == (value, type(value))


def test_paths_are_rewritten_and_added(source: Path) -> None:
    rewrites = {
        "amcl.ros__parameters.plugins.0": "voxel",
        "amcl.ros__parameters.alpha9": "0.5",
        "new.ros__parameters.gains.p": "1.5",
        "amcl.no_parameter": "x",
    }
    data = rewritten(source, rewrites, convert_types=True)
    assert data["amcl"]["ros__parameters"]["plugins"] == ["voxel", "SCAN"]
    assert data["amcl"]["ros__parameters"]["alpha9"] == 0.5
    assert data["new"] == {"ros__parameters": {"gains": {"p": 1.5}}}
    assert list(data["amcl"]) == ["ros__parameters"]


def test_keys_and_values_are_rewritten_and_all_is_put_under_a_key(source: Path) -> None:
    made = context(namespace="robot1", scan="/front")
    data = rewritten(
        source,
        {},
        made,
        root_key=LaunchConfiguration("namespace"),
        key_rewrites={"amcl": "localization"},
        value_rewrites={"SCAN": LaunchConfiguration("scan"), "3": "5"},
        convert_types=True,
    )
    assert list(data) == ["robot1"]
    parameters = data["robot1"]["localization"]["ros__parameters"]
    assert (parameters["scan_topic"], parameters["plugins"]) == ("/front", ["static", "/front"])
    assert data["robot1"]["local_costmap"]["local_costmap"]["ros__parameters"]["width"] == 5
    assert "robot1" not in rewritten(source, {}, context(namespace=""), root_key=LaunchConfiguration("namespace"))


def test_what_cannot_be_rewritten_is_one_line(source: Path, tmp_path: Path) -> None:
    with pytest.raises(LaunchError, match=r"no file '.*nav2_parms.yaml' \(did you mean 'nav2_params.yaml'\?\)"):
        RewrittenYaml(str(tmp_path / "nav2_parms.yaml"), {}).perform(context())
    with pytest.raises(LaunchError, match=r"has no place for 'amcl\.ros__parameters\.plugins\.7'"):
        rewritten(source, {"amcl.ros__parameters.plugins.7": "x"})
    with pytest.raises(LaunchError, match=r"has no place for 'amcl\.ros__parameters\.alpha1\.x'"):
        rewritten(source, {"amcl.ros__parameters.alpha1.x": "x"})
    with pytest.raises(LaunchError, match="no file can be written in"):
        rewritten(source, {}, out_dir=str(tmp_path / "missing"))
    source.write_text("- 1")
    with pytest.raises(LaunchError, match="expected a mapping of names to values"):
        RewrittenYaml(str(source), {}).perform(context())


DATA = st.recursive(
    st.none() | st.booleans() | st.integers(-(2**40), 2**40) | st.floats(allow_nan=False) | st.text(max_size=5),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=5), inner, max_size=3),
    max_leaves=8,
)


@given(data=st.dictionaries(st.text(max_size=5), DATA, max_size=3))
def test_without_rewrites_the_copy_is_the_same(data: dict[str, Any], tmp_path_factory: pytest.TempPathFactory) -> None:
    source = tmp_path_factory.getbasetemp() / "any.yaml"
    source.write_text(spell(data), encoding="utf-8")
    path = RewrittenYaml(str(source), {}).perform(context())
    assert parse(Path(path).read_text(encoding="utf-8")) == data


def test_texts_are_replaced_under_a_condition(source: Path) -> None:
    replacements = {"SCAN": LaunchConfiguration("scan")}
    always = ReplaceString(str(source), replacements).perform(context(scan="/front"))
    assert Path(always).read_text() == SOURCE.replace("SCAN", "/front")
    never = ReplaceString(str(source), replacements, condition=IfCondition("false"))
    assert never.perform(context(scan="/front")) == str(source)


def test_questions(source: Path, tmp_path: Path) -> None:
    (tmp_path / "empty.yaml").write_text("\n")
    assert HasNodeParams(str(tmp_path / "empty.yaml"), "amcl").perform(context()) == "False"
    assert [HasNodeParams(str(source), name).perform(context()) for name in ("amcl", "planner")] == ["True", "False"]
    answers = {text: LaunchConfigAsBool("slam").perform(context(slam=text)) for text in ("yes", "On", "1", "no", "x")}
    assert answers == {"yes": "True", "On": "True", "1": "True", "no": "False", "x": "False"}
    with pytest.raises(LaunchError, match="slam"):
        LaunchConfigAsBool("slam").perform(context())


def test_poses_of_several_robots(monkeypatch: pytest.MonkeyPatch) -> None:
    rest = {"z": 0.0, "roll": 0.0, "pitch": 0.0}
    expected = {"ada": {"x": 1.0, "y": 0.0, "yaw": 1.57, **rest}, "bob": {"x": 0.0, "y": 2, "yaw": 0.0, **rest}}
    text = "ada={x: 1.0, yaw: 1.57}; bob = {y: 2};"
    made = context(robots=text)
    assert ParseMultiRobotPose(LaunchConfiguration("robots")).perform(made) == expected
    assert ParseMultiRobotPose("robots").perform(made) == expected
    assert ParseMultiRobotPose("others").perform(made) == {}
    monkeypatch.setattr("sys.argv", ["robolink", "launch", f"robots:={text}"])
    assert ParseMultiRobotPose("robots").value() == expected
    with pytest.raises(LaunchError, match=r"a robot is NAME=\{x: 1.0, y: 1.0, yaw: 0.0\}, got 'ada=1'"):
        ParseMultiRobotPose(LaunchConfiguration("robots")).perform(context(robots="ada=1"))
