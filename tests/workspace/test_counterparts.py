"""Counterparts: executables of ROS packages that are found here under their ROS names."""

from __future__ import annotations

from pathlib import Path

import pytest

from robolink.cli.main import main
from robolink.exceptions import NotFoundError
from robolink.workspace import find_executable, find_node, program
from robolink.workspace.programs import PROGRAMS
from tests.support.ros_tree import write_package


@pytest.fixture
def ours(monkeypatch: pytest.MonkeyPatch) -> None:
    """A package of the table with two executables, whose code is robolink's."""
    rows = {
        "ros_control_demo.control_node": "robolink.control.pid:PID",
        "ros_control_demo.info": "robolink.bag:about",
    }
    monkeypatch.setattr(PROGRAMS, "table", lambda: rows)


@pytest.mark.usefixtures("ours")
def test_a_row_is_a_file_and_a_name_in_it() -> None:
    source = find_node("ros_control_demo control-node")
    assert source.path.parts[-2:] == ("control", "pid.py")
    assert (source.name, source.attribute) == ("control_node", "PID")
    assert find_node("ros-control-demo control_node.py") == source
    package = program("ros_control_demo", "info")
    assert package is not None
    assert package.path.parts[-2:] == ("bag", "__init__.py")


def test_a_component_is_found_by_its_class() -> None:
    source = find_node("image_tools::Cam2Image")
    assert (source.name, source.attribute) == ("cam2_image", "Cam2Image")
    with pytest.raises(NotFoundError, match=r"no component named 'image_tools::Cam3Image' .*Cam2Image"):
        find_node("image_tools::Cam3Image")


@pytest.mark.usefixtures("ours")
def test_a_users_own_package_goes_first(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    own = write_package(tmp_path / "src", "ros_control_demo", {"info.py": "def main(): return 'own'\n"})
    monkeypatch.chdir(own)
    assert find_executable("ros_control_demo", "info").path == own / "ros_control_demo/info.py"
    assert find_executable("ros_control_demo", "control_node").attribute == "PID"  # which the own one has not


@pytest.mark.usefixtures("ours")
@pytest.mark.parametrize(
    ("words", "report"),
    [
        (["ros_control_demo", "contol_node"], "no executable named 'contol_node' in package ros_control_demo"),
        (["ros_control_demo"], "ros_control_demo is a package: say which of its executables, control_node or info"),
        (["ros_contrl_demo", "info"], "(did you mean 'ros_control_demo'?)"),
    ],
)
def test_what_the_table_lacks_is_one_line(
    words: list[str], report: str, capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["run", *words]) == 1
    err = capsys.readouterr().err
    assert (report in err, err.count("\n")) == (True, 1)
    if len(words) == 2:
        with pytest.raises(NotFoundError):
            find_node(" ".join(words))


def test_a_file_with_a_space_in_its_path_is_no_executable(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "my files").mkdir()
    for name in ("my files/node.py", "my node.py"):
        (tmp_path / name).write_text("def main(): pass\n")
        for spec in (name, f"{name}:main"):
            assert find_node(spec).path == tmp_path.resolve() / name
