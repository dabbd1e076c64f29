"""Files in formats of others are read by their own readers' rules: what those ignore is told, and is not an error."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from robolink import Context, Node
from robolink.bag.metadata import read_metadata
from robolink.bag.output_options import chunk_compression, read_outputs
from robolink.bag.qos import read_qos_overrides
from robolink.bag.topic import read_static_topics
from robolink.counterparts.urdf import read_urdf
from robolink.documents.foreign import FileWarning, in_a_line, warnings_to
from robolink.exceptions import DocumentError
from robolink.impl.log_output import Record
from robolink.security import policy
from robolink.sim.maps.gridmap import load_map
from robolink.sim.worldfile import load_world

MAP = "image: m.pgm\nresolution: 0.5\norigin: [0, 0, 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.25\n"
METADATA = "rosbag2_bagfile_information:\n  version: 9\n  storage_identifier: mcap\n"
LINK = '<robot name="r"><link name="base"/>'
LEG = '<joint name="leg" type="fixed"><parent link="base"/><child link="foot"/>%s</joint><link name="foot"/>'

Case = tuple[Callable[[Path], Any], str, str, str]


def read_section(path: Path) -> Any:
    """Read the section of a URDF file that is for Webots' driver."""
    from robolink.counterparts.webots_ros2_driver import section

    return section.read_section(str(path))


TOLD: list[Case] = [
    (load_map, "m.yaml", MAP + "reslution: 1\n", "unknown key 'reslution' (did you mean 'resolution'?)"),
    (read_urdf, "r.urdf", LINK + "<jiont/></robot>", "<robot>: unknown key 'jiont' (did you mean 'joint'?)"),
    (read_urdf, "r.urdf", LINK + LEG % '<orgin xyz="1 2 3"/>' + "</robot>", "<joint>: unknown key 'orgin'"),
    (read_urdf, "r.urdf", LINK + LEG % '<origin xzy="1 2 3"/>' + "</robot>", "<origin>: unknown key 'xzy'"),
    (
        lambda path: read_metadata(path.parent),
        "metadata.yaml",
        METADATA + "  durations: 3\n",
        "unknown key 'durations'",
    ),
    (read_static_topics, "s.yaml", "static_topics_and_types_list: []\nstatics: 1\n", "unknown key 'statics'"),
    (lambda path: chunk_compression("", str(path)), "c.yaml", "compresion: Zstd\n", "(did you mean 'compression'?)"),
    (read_outputs, "o.yaml", "output_bags: [{uri: a, all_topics: true, tpics: []}]", "(did you mean 'topics'?)"),
]
"""Readers of each format with a file that has a word which the format's own reader ignores, and what is told of it."""

OF_WEBOTS: list[Case] = [
    (load_world, "w.wbt", "#VRML_SIM R2023b utf8\nSolid { nmae 3 }", "unknown key 'nmae' (did you mean 'name'?)"),
    (load_world, "w.wbt", "#VRML_SIM R2023b utf8\nSofa { }", "not known here"),
    (load_world, "w.wbt", "#VRML_SIM R2023b utf8\nE-puck { vresion 2 }", "(did you mean 'version'?)"),
    (
        read_section,
        "r.urdf",
        LINK + '<webots><device reference="a"><ros><updateRat>2</updateRat></ros></device></webots></robot>',
        "device 'a': unknown key 'updateRat' (did you mean 'updateRate'?)",
    ),
    (read_section, "r.urdf", LINK + "<webots><plugn/></webots></robot>", "<webots>: unknown"),
]
"""The same of Webots' formats."""

REFUSED: list[Case] = [
    (read_qos_overrides, "q.yaml", "/a: {histroy: keep_all}", "unknown key 'histroy'"),
    (
        policy.load,
        "p.xml",
        '<policy version="0.2.0"><enclaves><enclave path="/a"><profile/></enclave></enclaves></policy>',
        "profile",
    ),
]
"""Formats whose own readers refuse what they do not know: ros2bag's QoS overrides, SROS2's policies (by its schema)."""

OURS: list[Case] = [(load_world, "w.yaml", "wrld: {}", "unknown key 'wrld'")]
"""Our own formats are strict."""


def written(folder: Path, name: str, text: str) -> Path:
    (folder / "m.pgm").write_bytes(b"P5 1 1 255\n\0")
    (folder / name).write_text(text)
    return folder / name


@pytest.mark.parametrize(
    ("read", "name", "text", "told"),
    [*TOLD, *(pytest.param(*case, marks=pytest.mark.annex("webots")) for case in OF_WEBOTS)],
)
def test_what_the_formats_own_reader_ignores_is_told(
    tmp_path: Path, read: Callable[[Path], Any], name: str, text: str, told: str
) -> None:
    path = written(tmp_path, name, text)
    with pytest.warns(FileWarning) as caught:
        read(path)
    (found,) = (str(each.message) for each in caught)
    assert found.startswith(f"{path}:")
    assert told in found
    assert "\n" not in found


@pytest.mark.parametrize(("read", "name", "text", "told"), REFUSED + OURS)
def test_what_the_formats_own_reader_refuses_is_refused(
    tmp_path: Path, read: Callable[[Path], Any], name: str, text: str, told: str
) -> None:
    path = written(tmp_path, name, text)
    with pytest.raises(DocumentError) as caught:
        read(path)
    assert str(caught.value).startswith(f"{path}:")
    assert told in str(caught.value)


@pytest.mark.parametrize(
    "extension",
    [
        '<gazebo reference="base"><sensor/></gazebo>',
        '<ros2_control name="a" type="system"><hardware/></ros2_control>',
        '<transmission name="t"><type>x</type></transmission>',
        '<drake:tag xmlns:drake="http://drake.mit.edu" a="1"/>',
        "<webots><device reference='a'><ros><topicName>/x</topicName></ros></device></webots>",
    ],
)
def test_extensions_of_urdf_that_are_in_use_are_no_mistakes(tmp_path: Path, extension: str) -> None:
    path = written(tmp_path, "r.urdf", LINK + extension + "</robot>")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        read_urdf(path)


@pytest.mark.annex("webots")
def test_extensions_for_webots_that_are_in_use_are_no_mistakes(tmp_path: Path) -> None:
    extension = "<webots><device reference='a'><ros><topicName>/x</topicName></ros></device></webots>"
    path = written(tmp_path, "r.urdf", LINK + '<gazebo reference="base"><sensor/></gazebo>' + extension + "</robot>")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        read_section(path)


def test_a_parameter_that_no_node_declares_is_told(log_lines: list[Record], tmp_path: Path) -> None:
    path = written(tmp_path, "p.yaml", "robot:\n  ros__parameters:\n    sped: 1.0\n")
    context = Context(transport="memory")
    context.init(["--ros-args", "--params-file", str(path)])
    with context, Node("robot", context=context) as node:
        node.declare_parameter("speed", 0.5)
    (line,) = log_lines
    assert line.message == "parameter 'sped' was given, but no node declared it (did you mean 'speed'?)"


def test_commands_tell_each_warning_in_one_line(capsys: pytest.CaptureFixture[str]) -> None:
    with in_a_line():
        warnings.warn("m.yaml:1:1: odd", FileWarning, stacklevel=1)
        with warnings_to(lambda _: None):
            warnings.warn("taken elsewhere", FileWarning, stacklevel=1)
    assert capsys.readouterr().err == "robolink: m.yaml:1:1: odd\n"


def test_other_warnings_pass() -> None:
    with pytest.warns(RuntimeWarning, match="other"), warnings_to(lambda _: None):
        warnings.warn("other", RuntimeWarning, stacklevel=1)
