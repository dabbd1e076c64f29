"""robolink world: check, draw, list and schema; and the picture of a world."""

from __future__ import annotations

import builtins
import importlib
import json
import subprocess
import sys
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from matplotlib.colors import to_hex
from matplotlib.figure import Figure
from matplotlib.patches import Polygon
from matplotlib.text import Annotation

from robolink.cli.main import main
from robolink.cli.shared import complete
from robolink.documents.yamlfile import parse
from robolink.sim import drawing, load_world
from robolink.sim.description import MapWalls, WorldDescription
from robolink.sim.schema import MEANINGS, world_schema
from robolink.sim.sensors import SENSORS
from robolink.workspace import VARIABLE

WORLDS = Path(__file__).parents[3] / "configs" / "worlds"
Captured = pytest.CaptureFixture[str]

HALL = """\
world: {name: hall}
walls: [{polyline: [[0, 0], [4, 0], [4, 3]]}]
robots: [{name: ada, pose: [1, 1], sensors: [{lidar: scan}, {imu: imu}]}]
"""


@pytest.fixture
def workspace(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A workspace with a world, which is the working directory."""
    (tmp_path / "nodes").mkdir()
    (tmp_path / "configs" / "worlds").mkdir(parents=True)
    (tmp_path / "configs" / "worlds" / "hall.yaml").write_text(HALL)
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv(VARIABLE, raising=False)
    return tmp_path


# --- check ----------------------------------------------------------------------------------------------------


def test_a_good_world_is_told_what_it_has(workspace: Path, capsys: Captured) -> None:
    assert main(["world", "check", "hall"]) == 0
    path = Path("configs") / "worlds" / "hall.yaml"
    assert capsys.readouterr() == (f"{path}: OK: 2 walls, 1 robot with 2 sensors\n", "")


def test_every_problem_of_every_file_is_a_line(workspace: Path, capsys: Captured) -> None:
    Path("a.yaml").write_text("robots: [{name: a, pose: [0, 0], drive: {v_max: 99, steer_max: 1}}]")
    Path("b.yaml").write_text("wals: []\nrobots: [{}]")
    assert main(["world", "check", "./a.yaml", "hall", "b.yaml", "hal"]) == 1
    out, err = capsys.readouterr()
    assert err == ""
    assert [line.partition(": ")[0] for line in out.splitlines()] == [
        "a.yaml:1:53",
        "a.yaml:1:49",
        str(Path("configs") / "worlds" / "hall.yaml"),
        "b.yaml:2:10",
        "b.yaml:1:1",
        f"no world named 'hal' in {workspace} or robolink itself (did you mean 'hall'?)",
    ]


def test_a_program_reads_json(workspace: Path, capsys: Captured) -> None:
    Path("a.yaml").write_text("wals: []")
    assert main(["world", "check", "--json", "hall", "a.yaml"]) == 1
    good, bad = json.loads(capsys.readouterr().out)
    assert good == {"file": str(Path("configs") / "worlds" / "hall.yaml"), "problems": []}
    assert bad == {"file": "a.yaml", "problems": ["a.yaml:1:1: wals: unknown key 'wals' (did you mean 'walls'?)"]}


@pytest.mark.parametrize("path", sorted(WORLDS.glob("*.yaml")), ids=lambda path: path.stem)
def test_the_worlds_that_come_along_are_good(path: Path, capsys: Captured) -> None:
    assert main(["world", "check", str(path)]) == 0
    assert ": OK: " in capsys.readouterr().out


@pytest.mark.annex("webots")
def test_a_webots_world_is_checked_and_what_it_lacks_is_told(
    workspace: Path, capsys: Captured, monkeypatch: pytest.MonkeyPatch
) -> None:
    from robolink.sim import webots

    def load(path: str, text: str | None) -> WorldDescription:
        warnings.warn("left out: Pedestrian", webots.WorldWarning, stacklevel=2)
        return load_world("x.yaml", text=HALL)

    monkeypatch.setattr(webots, "load", load)
    Path("lab.wbt").write_text("#VRML_SIM R2023b utf8\n")
    assert main(["world", "check", "lab.wbt"]) == 0
    assert capsys.readouterr() == (
        "lab.wbt: OK: 2 walls, 1 robot with 2 sensors\n",
        "robolink: left out: Pedestrian\n",
    )


# --- list and schema ------------------------------------------------------------------------------------------


def test_worlds_are_listed_the_own_ones_too(workspace: Path, capsys: Captured) -> None:
    assert main(["world", "list"]) == 0
    assert {"hall", "corners", "office"} <= set(capsys.readouterr().out.split())
    assert main(["world", "list", "--json"]) == 0
    files = {each["name"]: Path(each["file"]) for each in json.loads(capsys.readouterr().out)}
    assert files["hall"] == workspace / "configs" / "worlds" / "hall.yaml"


HEAVY = {"numpy", "zenoh", "matplotlib", "robolink.sim.world", "robolink.node"}


@pytest.mark.processes
@pytest.mark.parametrize(
    ("verb", "more"),
    [("'list'", {"pymunk", "msgspec", "yaml"}), ("'schema'", {"pymunk", "yaml"}), ("'check', 'corners'", set())],
)
def test_commands_import_nothing_that_they_do_not_need(verb: str, more: set[str]) -> None:
    code = f"import sys; from robolink.cli.main import main; main(['world', {verb}]); print(*sys.modules)"
    shown = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
    assert "robolink.cli.world" in shown.split()
    assert not set(shown.splitlines()[-1].split()) & (HEAVY | more)


def test_the_schema_that_comes_along_is_the_present_one(workspace: Path, capsys: Captured) -> None:
    assert main(["world", "schema"]) == 0
    assert capsys.readouterr().out == (WORLDS / "world.schema.json").read_text(encoding="utf-8")
    assert main(["world", "schema", "--out", "mine.json"]) == 0
    assert Path("mine.json").read_bytes() == (WORLDS / "world.schema.json").read_bytes()
    assert main(["world", "schema", "--out", "no/where.json"]) == 1
    assert capsys.readouterr().err.count("\n") == 1


@pytest.fixture(scope="module")
def validator() -> Any:
    jsonschema = importlib.import_module("jsonschema")  # by name, since it has no types
    jsonschema.Draft7Validator.check_schema(world_schema())
    return jsonschema.Draft7Validator(world_schema())


@pytest.mark.parametrize("path", sorted(WORLDS.glob("*.yaml")), ids=lambda path: path.stem)
def test_the_schema_takes_the_worlds_that_come_along(path: Path, validator: Any) -> None:
    text = path.read_text(encoding="utf-8")
    assert text.startswith("# yaml-language-server: $schema=world.schema.json\n")
    assert [each.message for each in validator.iter_errors(parse(text))] == []


@pytest.mark.parametrize(
    "text",
    [
        "wals: []",
        "world: {dt: 0}",
        "obstacles: [{pose: [1, 1]}]",
        "obstacles: [{pose: [1, 1], circle: 1, box: [1, 1]}]",
        "robots: [{name: r}]",
        "robots: [{name: r, pose: [1, 2, 3, 4]}]",
        "robots: [{name: r, pose: [1, 2], drive: {type: dif}}]",
        "robots: [{name: r, pose: [1, 2], sensors: [{lidar: scan, beams: 1}]}]",
        "robots: [{name: r, pose: [1, 2], sensors: [{sonar: scan}]}]",
        "walls: [{polyline: [[1, 2, 3], [4, 5]]}]",
    ],
)
def test_the_schema_refuses_what_reading_refuses(text: str, validator: Any) -> None:
    assert list(validator.iter_errors(parse(text)))


def test_a_key_without_a_description_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delitem(MEANINGS, "rate")
    with pytest.raises(LookupError, match=r"^\w+\.rate has no description for editors: give it "):
        world_schema()


def test_the_description_of_a_part_does_not_list_its_keys_again() -> None:
    schema = world_schema()
    parts = {"WorldDescription": schema, **schema["definitions"]}
    assert [name for name, part in parts.items() if "Args:" in part.get("description", "")] == []


def test_the_schema_says_what_every_key_means() -> None:
    schema = world_schema()
    for part in (schema, *schema["definitions"].values()):
        assert all(each["description"] for each in part.get("properties", {}).values())
    kinds = [
        each["$ref"].rpartition("/")[2]
        for each in schema["definitions"]["RobotDescription"]["properties"]["sensors"]["items"]["oneOf"]
    ]
    assert kinds == [each.description.__name__ for each in SENSORS.table().values()]
    assert set(kinds) <= set(schema["definitions"])


# --- draw -----------------------------------------------------------------------------------------------------


@pytest.mark.slow
@pytest.mark.parametrize(("suffix", "begins"), [("png", b"\x89PNG"), ("svg", b"<?xml"), ("PDF", b"%PDF")])
def test_a_picture_is_drawn(
    workspace: Path, suffix: str, begins: bytes, capsys: Captured, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delitem(sys.modules, "matplotlib.pyplot", raising=False)  # another test's
    assert main(["world", "draw", "lab", f"lab.{suffix}"]) == 0
    assert Path(f"lab.{suffix}").read_bytes().startswith(begins)
    assert capsys.readouterr() == ("", "")
    assert "matplotlib.pyplot" not in sys.modules  # which could open a window


@pytest.mark.slow
def test_the_longer_side_has_the_size(workspace: Path) -> None:
    assert main(["world", "draw", "hall", "hall.png", "--size", "500"]) == 0
    header = Path("hall.png").read_bytes()[16:24]
    assert int.from_bytes(header[:4], "big") == 500
    assert 300 < int.from_bytes(header[4:], "big") < 500


@pytest.mark.parametrize(
    ("args", "report"),
    [
        (["hall", "hall.gif"], "'hall.gif' is not a picture that can be drawn: end its name in .png, .svg, .pdf"),
        (["hall", "hall"], "'hall' is not a picture that can be drawn"),
        (["hell", "hall.png"], "no world named 'hell'"),
        (["hall", "no/where/hall.png"], "No such file or directory"),
    ],
)
def test_what_cannot_be_drawn_is_one_line(workspace: Path, args: list[str], report: str, capsys: Captured) -> None:
    assert main(["world", "draw", *args]) == 1
    out, err = capsys.readouterr()
    assert (out, err.count("\n")) == ("", 1)
    assert report in err


def test_without_matplotlib_it_is_said_how_to_get_it(
    workspace: Path, capsys: Captured, monkeypatch: pytest.MonkeyPatch
) -> None:
    real = builtins.__import__

    def without(name: str, *rest: Any) -> Any:
        if name.partition(".")[0] == "matplotlib":
            raise ImportError(name)
        return real(name, *rest)

    monkeypatch.setattr(builtins, "__import__", without)
    assert main(["world", "draw", "hall", "hall.png"]) == 1
    report = "robolink: drawing needs matplotlib, which is not installed: pip install matplotlib\n"
    assert capsys.readouterr() == ("", report)


def test_everything_is_where_it_is_in_the_world() -> None:
    axes = Figure().add_subplot()
    kinds = drawing.draw_world(axes, load_world(WORLDS / "lab.yaml"))
    assert [each.get_label() for each in kinds] == ["can be pushed", "moves by itself"]
    assert axes.get_aspect() == 1.0
    assert [each.get_text() for each in axes.texts] == ["ada", "bob"]
    walls = [segment for each in axes.collections for segment in each.get_segments()]  # type: ignore[attr-defined]
    assert len(walls) == 6
    (x1, x2), (y1, y2) = axes.get_xlim(), axes.get_ylim()
    assert (x1 < 0.0, x2 > 10.0, y1 < 0.0, y2 > 8.0) == (True, True, True, True)
    table = next(each for each in axes.patches if isinstance(each, Polygon))
    assert table.get_xy()[:4] == pytest.approx(np.array([[2.0, 7.55], [0.4, 7.55], [0.4, 6.85], [2.0, 6.85]]))


SEEN = """
world: {floor: {colour: navy}}
walls: [{polyline: [[0, 0], [4, 0]], colour: red}]
obstacles: [{circle: 0.2, pose: [1, 1], colour: lime}]
robots: [{name: r, pose: [3, 1], colour: '#010203', signs: [{tag: 36h11/1, pose: [0.2, 0], size: 0.1}]}]
paint: [{box: [1, 0.5], pose: [2, 2], colour: yellow}]
signs: [{tag: 36h11/7, pose: [4, 3, 3.14159265], size: 0.5, z: 0.5}]
"""


def test_colours_paint_and_signs_are_drawn() -> None:
    axes = Figure().add_subplot()
    assert drawing.draw_world(axes, load_world("w.yaml", text=SEEN)) == []
    assert to_hex(axes.get_facecolor()) == "#000080"
    assert [to_hex(each.get_facecolor()) for each in axes.patches] == ["#00ff00", "#010203"]
    (image,) = axes.images
    assert image.get_extent() == pytest.approx((1.5, 2.5, 1.75, 2.25))
    assert np.asarray(image.get_array())[10, 10].tolist() == [255, 255, 0]
    assert sorted(each.get_text() for each in axes.texts) == ["36h11/1", "36h11/7", "r"]
    plates = [np.asarray(each.get_xydata()) for each in axes.lines if each.get_color() == drawing.SIGN]
    assert plates[2].tolist() == [pytest.approx([4.0, 3.0]), pytest.approx([3.75, 3.0])]
    assert len(plates) == 6


def test_paint_and_signs_are_counted(workspace: Path, capsys: Captured) -> None:
    Path("seen.yaml").write_text(SEEN, encoding="utf-8")
    assert main(["world", "check", "seen.yaml"]) == 0
    assert "1 wall, 1 obstacle, 1 painted, 2 signs, 1 robot" in capsys.readouterr().out


def test_an_outline_is_turned_with_its_pose() -> None:
    axes = Figure().add_subplot()
    text = "robots: [{name: r, pose: [1, 2, 1.5707963267948966], shape: {box: [0.4, 0.2]}}]"
    drawing.draw_world(axes, load_world("w.yaml", text=text))
    (box,) = axes.patches
    assert isinstance(box, Polygon)
    assert box.get_xy()[0].tolist() == pytest.approx([0.9, 2.2])
    (nose,) = axes.lines
    (x1, y1), (x2, y2) = np.asarray(nose.get_xydata()).tolist()
    assert (x1, y1, x2) == pytest.approx((1.0, 2.0, 1.0))
    assert y2 > 2.1


WITH_WHEELS = """
robots:
  - name: r
    pose: [1, 2, 0]
    shape: {box: [0.3, 0.3]}
    wheels:
      - {motor: left, at: [0, 0.15, 0], radius: 0.15}
      - {motor: right, at: [0, -0.15, 0], radius: 0.15}
"""


def test_a_robot_alone_in_its_world_does_not_fill_the_picture_and_its_name_is_below_its_wheels() -> None:
    axes = Figure().add_subplot()
    drawing.draw_world(axes, load_world("w.yaml", text=WITH_WHEELS))
    (x1, x2), (y1, y2) = axes.get_xlim(), axes.get_ylim()
    assert x2 - x1 > 5 * 0.3
    assert y2 - y1 > 5 * 0.3
    assert ((x1 + x2) / 2, (y1 + y2) / 2) == pytest.approx((1.0, 2.0), abs=0.01)
    (name,) = axes.texts
    assert isinstance(name, Annotation)
    assert name.xy == pytest.approx((1.0, 2.0 - 0.15 - 0.075 / 2))
    assert name.get_path_effects()


@pytest.mark.parametrize(
    "world",
    [
        WorldDescription(),
        load_world(
            "w.yaml", text="robots: [{name: r, pose: [1e5, -1e5], shape: {circle: 1e-3}, drive: {v_max: 0.01}}]"
        ),
        WorldDescription(walls=(MapWalls(()),)),
        load_world("w.yaml", text="walls: [{polyline: [[0, 0], [1e5, 0]]}]"),
    ],
    ids=["empty", "far away", "empty map", "a line"],
)
def test_any_world_can_be_drawn(world: WorldDescription, tmp_path: Path) -> None:
    drawing.save_world(world, tmp_path / "w.png", 300)
    assert (tmp_path / "w.png").stat().st_size > 0


# --- completion -----------------------------------------------------------------------------------------------


def test_names_folders_and_files_of_worlds_are_completed(workspace: Path) -> None:
    class Asked:
        params: dict[str, str] = {}

    Path("hallway.wbt").write_text("")
    Path("hall.txt").write_text("")
    Path("halls").mkdir()
    assert complete.world_files(Asked(), "hal") == ["hall", "halls/", "hallway.wbt"]  # type: ignore[arg-type]
    assert complete.world_files(Asked(), "configs/worlds/h") == ["configs/worlds/hall.yaml"]  # type: ignore[arg-type]
    assert complete.world_files(Asked(), "no/where/") == []  # type: ignore[arg-type]
