"""Templates of `robolink.scaffold`: names that it takes, files that it leaves alone, and that all of it works."""

from __future__ import annotations

import importlib
import json
import re
from pathlib import Path

import pytest
import yaml

from robolink.launch import plan
from robolink.scaffold import ScaffoldError, new_node, new_project, new_world, writing
from robolink.scaffold.writing import LONGEST, MODELINE, TEMPLATES, class_name, rendered, required, requirement
from robolink.sim.worldfile import check_world
from robolink.testing import System
from robolink.workspace import VARIABLE

ROOT = Path(__file__).parents[2]


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.delenv(VARIABLE, raising=False)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_no_placeholder_is_left_in_any_file() -> None:
    for kind in ("project", "node", "world", "exercise", "exercise_pt"):
        for path, text in rendered(kind, {"NAME": "demo", "CLASS": "Demo"}).items():
            assert "@" not in path
            assert "@NAME@" not in text
            assert "@CLASS@" not in text
            assert ".template" not in path


def test_every_template_is_of_a_kind() -> None:
    packages = ["package_cmake", "package_library", "package_python"]
    assert sorted(each.name for each in TEMPLATES.iterdir()) == [
        "exercise",
        "exercise_pt",
        "licenses",
        "node",
        *packages,
        "project",
        "world",
    ]


def test_a_project_launches_what_its_files_say(here: Path) -> None:
    made = new_project("demo")
    assert made.folder == here / "demo"
    assert [each.name for each in plan(here / "demo/configs/demo.yaml")] == ["world", "explorer"]
    assert not check_world(here / "demo/configs/worlds/room.yaml").errors


def test_its_ci_file_installs_and_tests(here: Path) -> None:
    new_project("demo")
    workflow = yaml.safe_load((here / "demo/.github/workflows/test.yml").read_text())
    steps = [each["run"] for each in workflow["jobs"]["test"]["steps"] if "run" in each]
    assert steps == ["pip install -r requirements.txt", "pytest"]
    assert (here / "demo/requirements.txt").read_text().splitlines()[-1] == requirement().line


CLONE = ROOT.as_uri()
NEEDED = {
    "index": ({}, "robolink[test]", ""),
    "git": (
        {"url": "https://example.com/robolink.git", "vcs_info": {"vcs": "git", "commit_id": "12ab"}},
        "robolink[test] @ git+https://example.com/robolink.git@12ab",
        "",
    ),
    "address": (
        {"url": "https://example.com/robolink-1.2-py3-none-any.whl", "archive_info": {}},
        "robolink[test] @ https://example.com/robolink-1.2-py3-none-any.whl",
        "",
    ),
    "clone": (
        {"url": CLONE, "dir_info": {"editable": True}},
        "./wheels/robolink-1.2-py3-none-any.whl[test]",
        f'pip wheel --no-deps --wheel-dir wheels "{ROOT}"',
    ),
    "lost clone": (
        {"url": f"{CLONE}/gone", "dir_info": {}},
        "./wheels/robolink-1.2-py3-none-any.whl[test]",
        'pip wheel --no-deps --wheel-dir wheels "PATH/OF/THE/CLONE"',
    ),
    "lost wheel": (
        {"url": f"{CLONE}/robolink-1.2-py3-none-any.whl", "archive_info": {}},
        "./wheels/robolink-1.2-py3-none-any.whl[test]",
        "cp PATH/OF/robolink-1.2-py3-none-any.whl wheels/",
    ),
}


@pytest.mark.parametrize("origin", NEEDED)
def test_a_project_requires_the_robolink_that_made_it(origin: str) -> None:
    found, line, step = NEEDED[origin]
    needs = required(found, "1.2")
    assert (needs.line, needs.step, needs.wheel) == (line, step, None)
    assert ("no package index" in needs.note) is line.startswith("./wheels/")


def test_a_wheel_goes_into_the_project(here: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    wheel = here / "robo link" / "robolink-1.2-py3-none-any.whl"
    wheel.parent.mkdir()
    wheel.write_bytes(b"PK\x03\x04\xff")
    needs = required({"url": wheel.as_uri(), "archive_info": {}}, "1.2")
    assert (needs.step, needs.wheel) == ("", wheel)
    monkeypatch.setattr(writing, "requirement", lambda: needs)
    assert f"wheels/{wheel.name}" in new_project("demo").files
    assert (here / "demo/wheels" / wheel.name).read_bytes() == wheel.read_bytes()
    assert needs.note in (here / "demo/README.md").read_text()
    last = (here / "demo/requirements.txt").read_text().splitlines()[-1]
    assert (here / "demo" / last.removesuffix("[test]")).is_file()


def test_its_readme_is_short_and_names_its_commands(here: Path) -> None:
    new_project("demo")
    readme = (here / "demo/README.md").read_text()
    assert len(readme.splitlines()) <= 18
    assert "@" not in readme
    assert "robolink launch demo" in readme


@pytest.mark.slow
def test_its_robot_explores_and_touches_nothing(here: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(new_project("demo").folder)
    with System(seed=3) as system:
        system.launch("demo")
        system.run(60.0)
        assert system.robot().contacts == 0
        assert system.robot().driven > 8.0


def test_a_node_says_what_its_parameter_has(here: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(new_project("demo").folder)
    made = new_node("wall-watcher")
    assert made.files == ["nodes/wall_watcher.py", "tests/test_wall_watcher.py"]
    with System() as system:
        system.start("wall_watcher", parameters={"words": "good morning"})
        assert system.expect("chatter", within=1.5).data == "good morning"


def test_without_a_workspace_a_node_is_one_file_here(here: Path) -> None:
    assert new_node("talker.py").files == ["talker.py"]
    assert new_world("kitchen").files == ["kitchen.yaml"]
    assert "$schema" not in (here / "kitchen.yaml").read_text()  # there is none beside it
    assert not check_world(here / "kitchen.yaml").errors


def test_a_workspace_of_ros_2_gets_no_folder_nodes(here: Path) -> None:
    (here / "src/demo").mkdir(parents=True)
    (here / "src/demo/package.xml").write_text("<package><name>demo</name></package>")
    assert new_node("talker").files == ["talker.py"]


def test_a_world_is_found_by_its_name(here: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(new_project("demo").folder)
    made = new_world("kitchen")
    assert made.files == ["configs/worlds/kitchen.yaml"]
    assert not check_world(made.folder / made.files[0]).errors


def schema_errors(file: Path) -> list[str]:
    """What an editor says of a file, by the schema that its first line names; nothing is asked of a network."""
    jsonschema = importlib.import_module("jsonschema")  # by name, since it has no types
    text = file.read_text(encoding="utf-8")
    first = text.splitlines()[0]
    assert first.startswith(MODELINE)
    schema = json.loads((file.parent / first.removeprefix(MODELINE)).read_text(encoding="utf-8"))
    assert not re.findall(r'"\$ref": "(?!#)', json.dumps(schema))
    return [each.message for each in jsonschema.Draft7Validator(schema).iter_errors(yaml.safe_load(text))]


def test_editors_find_the_schemas_of_a_project(here: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = new_project("demo").folder
    launch, room = folder / "configs/demo.yaml", folder / "configs/worlds/room.yaml"
    assert (schema_errors(launch), schema_errors(room)) == ([], [])
    launch.write_text(launch.read_text().replace("parameters:", "parametres:"))
    room.write_text(room.read_text().replace("circle: 0.2", "circle: big"))
    assert "parametres" in schema_errors(launch)[0]
    assert schema_errors(room)
    assert (folder / "configs/launch.schema.json").read_text() == (ROOT / "configs/launch.schema.json").read_text()
    monkeypatch.chdir(folder)
    (folder / "configs/worlds/world.schema.json").unlink()
    assert new_world("kitchen").files == ["configs/worlds/kitchen.yaml", "configs/worlds/world.schema.json"]
    assert schema_errors(folder / "configs/worlds/kitchen.yaml") == []


def test_what_is_there_stays_as_it_is(here: Path) -> None:
    (here / "talker.py").write_text("mine")
    with pytest.raises(ScaffoldError, match="is there already, and stays"):
        new_node("talker")
    assert (here / "talker.py").read_text() == "mine"
    (here / "demo").mkdir()
    (here / "demo/notes.txt").write_text("mine")
    with pytest.raises(ScaffoldError, match="not empty"):
        new_project("demo")
    (here / "notes").write_text("mine")
    with pytest.raises(ScaffoldError, match="not empty"):
        new_project("notes")


def test_an_empty_folder_becomes_a_project(here: Path) -> None:
    (here / "demo").mkdir()
    assert "README.md" in new_project("demo").files


@pytest.mark.parametrize("name", ["", "2nd", "my node", "é", "../up", "a" * (LONGEST + 1), "\x1b[2J", "-x"])
def test_names_that_are_none(here: Path, name: str) -> None:
    for make in (new_node, new_world):
        with pytest.raises(ScaffoldError, match="is not a name for a"):
            make(name)
    assert list(here.iterdir()) == []


def test_names_that_are_taken(here: Path) -> None:
    with pytest.raises(ScaffoldError, match="a node 'wall-follower' comes with robolink"):
        new_node("wall-follower")
    with pytest.raises(ScaffoldError, match="a world 'classroom' comes with robolink"):
        new_world("classroom.yaml")
    with pytest.raises(ScaffoldError, match="a node 'World' comes with robolink"):
        new_node("World")  # one file with `world` on macOS and Windows
    for name in ("import", "match", "True", "none"):
        with pytest.raises(ScaffoldError, match="a word of Python"):
            new_node(name)
    for name in ("random", "String", "std_msgs", "turtlesim", "robolink"):  # programs beside it would import it
        with pytest.raises(ScaffoldError, match="take another name, such as my_"):
            new_node(name)
    for make in (new_node, new_world, new_project):
        with pytest.raises(ScaffoldError, match="a device of Windows"):
            make("Con")
    assert list(here.iterdir()) == []


@pytest.mark.parametrize("name", ["Node", "external-shutdown-exception", "null", "on"])
def test_names_that_mean_something_in_a_template(here: Path, name: str) -> None:
    project = new_project(name).folder
    assert not check_world(project / new_world(name, workspace=project).files[0]).errors
    with System() as system:
        system.start(project / new_node(name, workspace=project).files[0])
        system.expect("chatter", within=2.0)


@pytest.mark.parametrize(("name", "class_"), [("talker", "Talker"), ("wall_watcher", "WallWatcher"), ("a-b2", "AB2")])
def test_a_class_is_named_after_its_node(name: str, class_: str) -> None:
    assert class_name(name) == class_


def test_a_full_disk_leaves_nothing_of_a_project(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    made: list[Path] = []

    def full(path: Path, data: bytes) -> None:
        made.append(path)
        if len(made) > 4:
            raise OSError(28, "No space left on device", str(path))
        path.write_bytes(data)

    monkeypatch.setattr(writing, "write_new", full)
    (tmp_path / "there").mkdir()
    for name in ("demo", "there/too"):
        made.clear()
        with pytest.raises(OSError, match="No space left"):
            new_project(str(tmp_path / name))
        assert len(made) > 4
        assert [each.name for each in tmp_path.rglob("*")] == ["there"]
