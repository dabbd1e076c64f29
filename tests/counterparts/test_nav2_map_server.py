"""nav2_map_server: maps from files onto /map, and from there into files."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from robolink.counterparts.nav2_map_server.map_files import (
    LoadResult,
    MapSaveError,
    Saving,
    grid_of,
    path_of,
    result_of,
    save,
)
from robolink.counterparts.nav2_map_server.map_saver import run_command
from robolink.exceptions import DocumentError
from robolink.interfaces.lifecycle_msgs.msg import Transition
from robolink.interfaces.lifecycle_msgs.srv import ChangeState
from robolink.interfaces.nav2_msgs.srv import LoadMap, SaveMap
from robolink.interfaces.nav_msgs.msg import OccupancyGrid
from robolink.interfaces.nav_msgs.srv import GetMap
from robolink.qos import DurabilityPolicy, QoSProfile
from robolink.sim.maps.formats import read_image
from robolink.testing import System

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
YAML = """image: m.pgm
resolution: 0.05
origin: [-1.0, 2.0, 1.5707963]
occupied_thresh: 0.65
free_thresh: 0.1
negate: 0
"""
CELLS = [0, 100, -1, 100, 100, 0]
"""Cells of the map from its lower left corner on, two rows of three."""


@pytest.fixture
def file(tmp_path: Path) -> Path:
    (tmp_path / "m.pgm").write_bytes(b"P5 3 2 255\n" + bytes([0, 0, 254, 254, 0, 205]))
    (tmp_path / "m.yaml").write_text(YAML)
    return tmp_path / "m.yaml"


def change(system: System, node: str, transition: int) -> bool:
    request = ChangeState.Request(transition=Transition(id=transition))
    return bool(system.call(ChangeState, f"/{node}/change_state", request).success)


def activated(system: System, node: str, **parameters: Any) -> None:
    system.start(f"nav2_map_server {node}", parameters=parameters)
    name = node.removesuffix("_server") if "saver" in node else node
    assert change(system, name, Transition.TRANSITION_CONFIGURE)
    assert change(system, name, Transition.TRANSITION_ACTIVATE)


def test_the_map_is_there_once_it_is_activated(system: System, file: Path) -> None:
    system.start("nav2_map_server map_server", parameters={"yaml_filename": str(file), "frame_id": "world"})
    assert change(system, "map_server", Transition.TRANSITION_CONFIGURE)
    heard = system.messages("/map", OccupancyGrid)
    system.run(1.0)
    assert heard == []
    assert change(system, "map_server", Transition.TRANSITION_ACTIVATE)
    system.run(1.0)
    (grid,) = heard
    assert list(grid.data) == CELLS
    assert (grid.info.width, grid.info.height, round(grid.info.resolution, 6)) == (3, 2, 0.05)
    assert (grid.info.origin.position.x, grid.info.origin.position.y) == (-1, 2)
    assert grid.info.origin.orientation.z == pytest.approx(math.sqrt(0.5))
    assert (grid.header.frame_id, grid.header.stamp.sec) == ("world", 1)
    assert list(system.expect("/map").data) == CELLS  # latched
    system.expect_log(f"Loading yaml file: {file}")
    system.expect_log("3 X 2 map @ 0.05 m/cell")


def test_services_give_the_map_and_load_another(system: System, file: Path, tmp_path: Path) -> None:
    activated(system, "map_server", yaml_filename=str(file))
    assert list(system.call(GetMap, "/map_server/map").map.data) == CELLS
    (tmp_path / "other.yaml").write_text(YAML.replace("0.05", "0.1"))
    answer = system.call(LoadMap, "/map_server/load_map", LoadMap.Request(map_url=f"file://{tmp_path}/other.yaml"))
    assert answer.result == LoadMap.Response.RESULT_SUCCESS
    assert system.expect("/map").info.resolution == pytest.approx(0.1)
    assert change(system, "map_server", Transition.TRANSITION_DEACTIVATE)
    assert system.call(GetMap, "/map_server/map").map.info.width == 0
    assert system.call(LoadMap, "/map_server/load_map").result == LoadMap.Response.RESULT_UNDEFINED_FAILURE
    assert change(system, "map_server", Transition.TRANSITION_CLEANUP)
    assert change(system, "map_server", Transition.TRANSITION_CONFIGURE)


def test_a_map_with_a_mistake_is_one_line_and_no_transition(system: System, file: Path) -> None:
    file.write_text(YAML.replace("0.05", "fast"))
    system.start("nav2_map_server map_server", parameters={"yaml_filename": str(file)})
    assert not change(system, "map_server", Transition.TRANSITION_CONFIGURE)
    system.expect_log(f"Failed to load map yaml file: {file}:2:13: resolution: expected float")


def test_a_map_of_another_dialect_is_loaded_from_the_home_folder(
    system: System, file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("HOME", str(file.parent))
    monkeypatch.setenv("USERPROFILE", str(file.parent))  # Windows
    file.write_text(YAML.replace("negate: 0", "negate: no\nmode: Trinary\nmap_type: occupancy"))
    activated(system, "map_server", yaml_filename="~/m.yaml")
    assert list(system.expect("/map").data) == CELLS
    system.expect_log(f"{file}:8:1: map_type: unknown key 'map_type': ignored")


@pytest.mark.parametrize(
    ("url", "path"),
    [
        ("file:///maps/my%20map.yaml", "/maps/my map.yaml"),
        ("file:///C:/maps/a.yaml", "C:/maps/a.yaml"),
        ("file:///c/maps/a.yaml", "/c/maps/a.yaml"),
        ("maps/a.yaml", "maps/a.yaml"),
        ("~other/a.yaml", "~other/a.yaml"),
    ],
)
def test_urls_of_maps_are_paths(url: str, path: str) -> None:
    assert path_of(url).as_posix() == path


def test_the_service_says_what_is_wrong(file: Path) -> None:
    def result(text: str) -> LoadResult:
        file.write_text(text)
        with pytest.raises(DocumentError) as error:
            grid_of(file)
        return result_of(error.value)

    assert result(YAML.replace("m.pgm", "n.pgm")) is LoadResult.INVALID_MAP_DATA
    assert result(YAML.replace("negate: 0", "negate: maybe")) is LoadResult.INVALID_MAP_METADATA
    with pytest.raises(DocumentError) as error:
        grid_of(file.parent / "nowhere.yaml")
    assert result_of(error.value) is LoadResult.MAP_DOES_NOT_EXIST


@pytest.mark.parametrize("form", ["pgm", "png"])
def test_a_map_that_is_saved_is_the_same_when_it_is_read(file: Path, tmp_path: Path, form: str) -> None:
    grid = grid_of(file)
    save(grid, Saving(str(tmp_path / "saved"), form))
    again = grid_of(tmp_path / "saved.yaml")
    assert list(again.data) == CELLS
    assert (again.info.resolution, again.info.origin.position) == (grid.info.resolution, grid.info.origin.position)
    assert again.info.origin.orientation.z == pytest.approx(grid.info.origin.orientation.z, abs=1e-5)
    assert read_image(tmp_path / f"saved.{form}").shades.tolist() == [[0, 0, 254], [254, 0, 205]]


@pytest.mark.parametrize("mode", ["scale", "raw"])
def test_numbers_between_are_kept_in_other_modes(tmp_path: Path, mode: str) -> None:
    grid = OccupancyGrid(data=np.array([0, 30, 64, 100, -1, 50], np.int8))
    grid.info.width, grid.info.height, grid.info.resolution = 3, 2, 1.0
    save(grid, Saving(str(tmp_path / "saved"), mode=mode, occupied=1.0, free=0.0))
    found = np.array(grid_of(tmp_path / "saved.yaml").data, int)
    assert np.abs(found - [0, 30, 64, 100, -1, 50]).max() <= 1


@pytest.mark.parametrize(
    ("how", "said"),
    [
        (Saving("x", "bmp"), "format: expected pgm or png, got 'bmp'"),
        (Saving("x", mode="trinry"), "mode: expected trinary or scale or raw, got 'trinry' .did you mean 'trinary'"),
        (Saving("x", "pgm", "scale"), "its format is png"),
        (Saving("x", free=0.7), "expected 0 <= free < occupied <= 1, got 0.7 and 0.65"),
        (Saving("x"), "a map of 3 x 2 cells has 1"),
    ],
)
def test_what_cannot_be_saved_is_one_line(how: Saving, said: str) -> None:
    grid = OccupancyGrid(data=np.zeros(1, np.int8))
    grid.info.width, grid.info.height = 3, 2
    with pytest.raises(MapSaveError, match=said):
        save(grid, how)


def test_the_saver_saves_on_request(system: System, file: Path, tmp_path: Path) -> None:
    activated(system, "map_server", yaml_filename=str(file))
    activated(system, "map_saver_server")
    request = SaveMap.Request(map_topic="map", map_url=str(tmp_path / "saved"))
    assert system.call(SaveMap, "/map_saver/save_map", request).result
    assert list(grid_of(tmp_path / "saved.yaml").data) == CELLS
    system.expect_log("Received a 3 X 2 map @ 0.05 m/pix")
    system.expect_log("Map saved successfully")
    request.map_topic = "nowhere"
    assert not system.call(SaveMap, "/map_saver/save_map", request).result
    system.expect_log("nothing came on 'nowhere' in time")
    request.map_topic, request.map_url = "map", str(tmp_path / "no/folder")
    assert not system.call(SaveMap, "/map_saver/save_map", request).result
    system.expect_log("Failed to save the map: ")


def test_the_command_saves_and_ends(system: System, file: Path, tmp_path: Path) -> None:
    activated(system, "map_server", yaml_filename=str(file))
    system.start("nav2_map_server map_saver_cli", args=["-f", str(tmp_path / "mine"), "--fmt", "png"])
    system.expect_log("Map saved successfully")
    assert list(grid_of(tmp_path / "mine.yaml").data) == CELLS


def test_the_command_fails_where_there_is_no_map(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("ROBOLINK_TRANSPORT", "memory://no-map")
    command = ["x", "-f", str(tmp_path / "mine"), "--ros-args", "-p", "save_map_timeout:=0.1"]
    assert run_command(command) == 1
    assert list(tmp_path.iterdir()) == []


def test_what_a_mask_means_is_published(system: System) -> None:
    activated(system, "costmap_filter_info_server", type=1, mask_topic="speeds", base=100.0, multiplier=-1.0)
    system.run(1.0)
    found = system.expect("/costmap_filter_info")
    assert (found.type, found.filter_mask_topic, found.base, found.multiplier) == (1, "speeds", 100, -1)
    assert change(system, "costmap_filter_info_server", Transition.TRANSITION_DEACTIVATE)
    assert change(system, "costmap_filter_info_server", Transition.TRANSITION_CLEANUP)
    assert system.node.get_publishers_info_by_topic("/costmap_filter_info") == []
