"""nav2_bringup: launch files of a whole navigation, under Nav2's names."""

from __future__ import annotations

from pathlib import Path

import pytest

from robolink.companions.ament_index import get_package_share_directory
from robolink.launch import plan, shared_process
from robolink.launch.lookup import find, parameter_file

SHARE = Path(get_package_share_directory("nav2_bringup"))


def test_the_package_is_found_by_its_name() -> None:
    assert (SHARE / "params/nav2_params.yaml").is_file()
    assert find(("nav2_bringup", "bringup_launch.py")) == SHARE / "launch/bringup_launch.py"
    assert parameter_file("nav2_bringup params/nav2_params.yaml", None, Path()) == SHARE / "params/nav2_params.yaml"
    with pytest.raises(LookupError, match=r"did you mean 'params/nav2_params.yaml'"):
        parameter_file("nav2_bringup params/nav2_parms.yaml", None, Path())


def test_a_launch_file_names_the_parameters_of_a_package(tmp_path: Path) -> None:
    text = (
        "nodes: [{node: nav2_map_server::MapServer, name: amcl, process: nav2,"
        " parameters: nav2_bringup params/nav2_params.yaml}]"
    )
    (process,) = plan(tmp_path / "x.yaml", text=text)
    (member,) = shared_process.read(process.input)
    assert "max_beams:=60" in member.args
    assert "/local_costmap/local_costmap:width:=3" in member.args  # the server makes that node itself
