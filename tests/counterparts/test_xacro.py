"""xacro: macros of robot descriptions, by the package of PyPI, and mistakes in them."""

from __future__ import annotations

import os
import sys
from pathlib import Path

import pytest

from robolink.counterparts.urdf import parse_urdf
from robolink.counterparts.xacro import expanded, main
from robolink.exceptions import DocumentError, RobolinkError
from robolink.launch.ros.launch.bases import LaunchContext
from robolink.launch.ros.launch.substitutions import Command, SubstitutionFailure

HEAD = '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">\n'
WHEELS = """<xacro:arg name="prefix" default="my_"/>
<xacro:property name="width" value="0.4"/>
<xacro:macro name="wheel" params="name side">
  <link name="$(arg prefix)${name}"/>
  <joint name="${name}_joint" type="continuous">
    <parent link="base"/><child link="$(arg prefix)${name}"/><origin xyz="0 ${side * width / 2} 0"/>
  </joint>
</xacro:macro>
<link name="base"/>
<xacro:wheel name="left" side="1"/>
<xacro:wheel name="right" side="-1"/>
"""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A workspace with a package `bot`, whose folder it is."""
    package = tmp_path / "src" / "bot"
    (package / "urdf").mkdir(parents=True)
    (package / "package.xml").write_text("<package format='3'><name>bot</name></package>")
    monkeypatch.setenv("ROBOLINK_WORKSPACE", str(tmp_path))
    return package


def written(folder: Path, body: str, name: str = "bot.urdf.xacro") -> str:
    path = folder / "urdf" / name
    path.write_text(f"{HEAD}{body}</robot>\n")
    return str(path)


def test_macros_are_expanded(folder: Path) -> None:
    robot = parse_urdf(expanded([written(folder, WHEELS)]))
    assert robot.links == ("base", "my_left", "my_right")
    assert robot.joints["right_joint"].origin[1] == -0.2


def test_arguments_of_the_command_go_before_defaults(folder: Path) -> None:
    assert parse_urdf(expanded([written(folder, WHEELS), "prefix:=b_"])).links == ("base", "b_left", "b_right")


def test_files_of_packages_are_found(folder: Path) -> None:
    written(folder, WHEELS, "wheels.xacro")
    file = written(folder, '<xacro:include filename="$(find bot)/urdf/wheels.xacro"/>')
    assert parse_urdf(expanded([file])).root == "base"


def test_the_command_prints_or_writes(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file, output = written(folder, WHEELS), folder / "bot.urdf"
    main(["xacro", file, "--ros-args", "--log-level", "info"])
    text = capsys.readouterr().out
    assert text.startswith("<?xml")
    main(["xacro", "-o", str(output), file])
    assert output.read_text() == text
    assert capsys.readouterr().out == ""


@pytest.mark.parametrize(
    ("body", "said"),
    [
        ("<link>", ":2:9: no XML: mismatched tag"),
        ('<a/>\n<link name="${nobody}"/>', ":3: name 'nobody' is not defined"),
        ("<xacro:nobody/>", ":2: unknown macro name: xacro:nobody"),
        ('<link name="$(arg nobody)"/>', ":2: Undefined substitution argument nobody"),
        ('<xacro:macro name="m" params="a"/>\n\n<xacro:m b="1"/>', "Invalid parameter"),
        ('<link name="${1/0}"/>', ":2: division by zero"),
        ('<xacro:include filename="$(find bott)/x"/>', ":2: no package named 'bott'"),
        ('<xacro:include filename="nowhere.xacro"/>', "nowhere.xacro: No such file"),
        ('<xacro:macro name="m"><xacro:m/></xacro:macro><xacro:m/>', ": a macro or a file contains itself without end"),
        ('<xacro:include filename="bot.urdf.xacro"/>', ": a macro or a file contains itself without end"),
        ('<xacro:if value="perhaps"/>', ":2: "),
    ],
)
def test_a_mistake_is_one_line_with_its_file(folder: Path, body: str, said: str) -> None:
    file = written(folder, body)
    with pytest.raises(RobolinkError) as error:
        expanded([file])
    assert str(error.value).startswith(file)
    assert said in str(error.value)
    assert "\n" not in str(error.value)
    assert len(str(error.value)) < len(file) + 400


def test_a_mistake_in_an_included_file_has_that_file(folder: Path) -> None:
    inner = written(folder, "\n<a b='${nobody}'/>", "inner.xacro")
    with pytest.raises(DocumentError, match=r"inner.xacro:3: name 'nobody' is not defined"):
        expanded([written(folder, '<xacro:include filename="inner.xacro"/>')])
    Path(inner).write_text("<robot>\n<a>")
    with pytest.raises(DocumentError, match=r"inner.xacro:2:4: no XML: no element found"):
        expanded([written(folder, '<xacro:include filename="inner.xacro"/>')])


def test_entities_are_refused(folder: Path) -> None:
    path = folder / "bomb.xacro"
    path.write_text('<!DOCTYPE r [<!ENTITY a "aaaa">]><robot name="&a;"/>')
    with pytest.raises(DocumentError, match=r"bomb.xacro:1: a DOCTYPE or entities"):
        expanded([str(path)])


def test_a_file_that_is_not_there(folder: Path) -> None:
    with pytest.raises(DocumentError, match=r"nowhere.xacro: No such file"):
        expanded([str(folder / "nowhere.xacro")])


def test_without_the_package_it_says_how_to_get_it(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for each in [name for name in sys.modules if name.partition(".")[0] == "xacro"]:
        monkeypatch.delitem(sys.modules, each)
    monkeypatch.setitem(sys.modules, "xacro", None)
    with pytest.raises(ImportError, match="pip install xacro"):
        expanded([written(folder, WHEELS)])


@pytest.mark.processes
def test_launch_files_get_the_same_text(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}")  # as in a venv
    file = written(folder, '<xacro:include filename="$(find bot)/urdf/wheels.xacro"/>')
    written(folder, WHEELS, "wheels.xacro")
    found = Command(["xacro ", file, " prefix:=b_"]).perform(LaunchContext())
    assert parse_urdf(found).links == ("base", "b_left", "b_right")
    (folder / "urdf/wheels.xacro").write_text("<robot>")
    with pytest.raises(SubstitutionFailure, match=r"wheels.xacro:1:8: no XML: no element found"):
        Command(["xacro ", file]).perform(LaunchContext())
