"""URDF: what its text means, and mistakes in it, each of which is one line with its place."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from robolink.counterparts.urdf import Mimic, parse_urdf, placed, read_urdf
from robolink.exceptions import DocumentError
from tests.support.urdfs import ARM, joint, robot


def test_a_robot_without_frames_has_one_link_without_a_name() -> None:
    placeholder = parse_urdf('<robot name="Webots"><link name=""/></robot>')
    assert (placeholder.root, list(placeholder.links), placeholder.joints) == ("", [""], {})


def test_an_arm_is_a_tree_of_links() -> None:
    arm = parse_urdf(ARM)
    assert (arm.name, arm.root) == ("arm", "base_link")
    assert arm.links == ("base_link", "camera", "upper", "slide", "left_finger", "right_finger")
    assert list(arm.joints) == ["mount", "shoulder", "extend", "left", "right"]
    shoulder = arm.joints["shoulder"]
    assert (shoulder.parent, shoulder.child, shoulder.axis) == ("base_link", "upper", (0, 0, 1))
    assert (shoulder.lower, shoulder.upper) == (-1.5, 1.5)
    assert arm.joints["extend"].soft == (None, 0.4)
    assert arm.joints["right"].mimic == Mimic("left", -2.0, 0.5)
    assert arm.joints["left"].axis == (1, 0, 0)


def test_where_the_child_of_a_joint_stands() -> None:
    arm = parse_urdf(ARM)
    half = math.sqrt(0.5)
    assert placed(arm.joints["mount"]) == pytest.approx((0.1, 0, 0.5, 0, 0, half, half))
    assert placed(arm.joints["shoulder"], math.pi / 2) == pytest.approx((0, 0, 1, 0, 0, half, half))
    assert placed(arm.joints["extend"], 0.3) == pytest.approx((0, 0.3, 0, 0, 0, 0, 1))
    assert placed(arm.joints["left"], math.pi / 2) == pytest.approx((0, 0, 0, half, 0, 0, half))


ANGLE, AXIS = st.floats(-3.0, 3.0), st.floats(-2.0, 2.0)


@given(st.tuples(ANGLE, ANGLE, ANGLE), st.tuples(AXIS, AXIS, AXIS).filter(lambda each: math.hypot(*each) > 1e-3), ANGLE)
def test_a_turned_joint_is_that_of_scipy(
    rpy: tuple[float, float, float], axis: tuple[float, float, float], position: float
) -> None:
    inner = f'<origin rpy="{rpy[0]} {rpy[1]} {rpy[2]}"/><axis xyz="{axis[0]} {axis[1]} {axis[2]}"/>'
    found = parse_urdf(robot(joint("j", "a", "b", inner, "continuous"), links="a b")).joints["j"]
    length = math.hypot(*axis)
    turned = Rotation.from_euler("xyz", rpy) * Rotation.from_rotvec([each / length * position for each in axis])
    assert Rotation.from_quat(placed(found, position)[3:]).approx_equal(turned, 1e-6)


def test_a_text_may_begin_with_an_empty_line_and_say_an_encoding() -> None:
    assert parse_urdf('\n\n<?xml version="1.0" encoding="latin-1"?>\n' + robot(links="é")).links == ("é",)


def test_tags_of_xacro_are_ignored_as_in_ros(tmp_path: Path) -> None:
    """TurtleBot3's files have some, and its launch file reads them as they are."""
    text = f'<!-- ours -->\n<?xml version="1.0"?>\n{XACRO}<xacro:include filename="x"/><link name="a"/></robot>'
    assert parse_urdf(text).links == ("a",)
    (tmp_path / "robot.urdf").write_text(text)
    assert read_urdf(tmp_path / "robot.urdf").links == ("a",)


def test_a_file_is_read_with_its_encoding(tmp_path: Path) -> None:
    file = tmp_path / "robot.urdf"
    file.write_bytes(('<?xml version="1.0" encoding="latin-1"?>' + robot(links="é")).encode("latin-1"))
    assert read_urdf(file).links == ("é",)


LIMIT = '<limit lower="0" upper="1"/>'
AB = joint("j", "a", "b")
XACRO = '<robot xmlns:xacro="http://www.ros.org/wiki/xacro">'


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "r:1:1: no XML: no element found"),
        ("<robot>", "r:1:8: no XML: no element found"),
        ("<sdf/>", "r:1: expected <robot>, got <sdf>: this is not URDF"),
        (robot(links=""), "r:1: a robot needs a <link>"),
        ("<robot><link/></robot>", 'r:1: <link> needs name="..."'),
        (robot(links="a b a"), "r:2: a second link 'a'; the first is in line 2"),
        (robot(AB, AB, links="a b"), "r:4: a second joint 'j'; the first is in line 3"),
        (robot(joint("j", "a", "b", kind="fixd")), "r:3: joint 'j': unknown type 'fixd' (did you mean 'fixed'?)"),
        (robot('<joint name="j"/>'), 'r:3: <joint> needs type="..."'),
        (robot('<joint name="j" type="fixed"/>'), "r:3: joint 'j' needs <parent link=\"...\"/>"),
        (robot(joint("j", "a", "bb"), links="a bbb"), "r:3: joint 'j': no link named 'bb' (did you mean 'bbb'?)"),
        (robot(joint("j", "a", "b", kind="revolute")), "r:3: joint 'j' is revolute and needs <limit lower="),
        (robot(joint("j", "a", "b", '<origin xyz="1 2"/>')), "r:3: xyz: expected three numbers, got '1 2'"),
        (robot(joint("j", "a", "b", '<origin rpy="1 2 nan"/>')), "r:3: rpy: expected a number, got 'nan'"),
        (robot(joint("j", "a", "b", '<origin xyz="1 2 1_0"/>')), "r:3: xyz: expected a number, got '1_0'"),
        (robot(joint("j", "a", "b", '<origin xyz="1 2 1e999"/>')), "r:3: xyz: expected a number, got '1e999'"),
        (robot(joint("j", "a", "b", '<axis xyz="0 0 0"/>', "continuous")), "r:3: an axis of length 0"),
        (robot(joint("j", "a", "b"), joint("k", "b", "a"), links="a b"), "r:3: links are below each other in a circle"),
        (robot(joint("j", "c", "b"), joint("k", "b", "c")), "r:3: links are below each other in a circle: b -> c -> b"),
        (robot(joint("j", "a", "c"), joint("k", "b", "c")), "r:4: link 'c' is the child of two joints, 'j' and 'k'"),
        (robot(AB), "r:2: two roots, 'a' and 'c': a joint has to connect them"),
        (f'{XACRO}<xacro:macro name="m"/>{AB}</robot>', "r:1: a robot needs a <link>; it has tags of xacro: run it"),
    ],
)
def test_a_mistake_is_one_line_with_its_place(text: str, said: str) -> None:
    with pytest.raises(DocumentError) as error:
        parse_urdf(text, "r")
    assert str(error.value).startswith(said)
    assert "\n" not in str(error.value)


BOMB = '<!DOCTYPE r [<!ENTITY a "aaaaaaaaaa"><!ENTITY b "&a;&a;&a;&a;&a;">]><robot name="r"><link name="&b;"/></robot>'
STOLEN = '<!DOCTYPE r [<!ENTITY a SYSTEM "file:///etc/passwd">]><robot name="r"><link name="a"/>&a;</robot>'


@pytest.mark.slow
@pytest.mark.parametrize(
    ("text", "said"),
    [
        (BOMB, "r:1: a DOCTYPE or entities, which are not read here"),
        (STOLEN, "r:1: a DOCTYPE or entities, which are not read here"),
        ("<robot>" + "<a>" * 10_000, "r:1: deeper than 32 elements"),
        ("<robot>" + "<a/>" * 100_001, "r:1: more than 100000 elements"),
        ("<robot>" + "x" * 5_000_001, "r: it is longer than 5 MB"),
        (f"<robot>{chr(0xD800)}", "r: it has characters that are none"),
        ("<robot>\0</robot>", "r:1:8: no XML: not well-formed (invalid token)"),
        (robot(joint("j", "a", "b", f'<origin xyz="1 2 {"9" * 100_000}"/>')), "r:3: xyz: expected a number"),
        (robot(joint("j", "a", "x" * 100_000)), "r:3: joint 'j': no link named 'xxx"),
        (robot(joint("\x1b[2J", "a", "b")), "r:3:"),
    ],
)
def test_what_is_hostile_is_one_line(text: str, said: str) -> None:
    with pytest.raises(DocumentError) as error:
        parse_urdf(text, "r")
    assert str(error.value).startswith(said)
    assert len(str(error.value)) < 400
    assert str(error.value).isprintable()


@pytest.mark.slow
def test_a_long_chain_is_read() -> None:
    count = 5_000
    links = " ".join(f"l{each}" for each in range(count + 1))
    chain = [joint(f"j{each}", f"l{each}", f"l{each + 1}") for each in range(count)]
    assert parse_urdf(robot(*chain, links=links)).root == "l0"
    with pytest.raises(DocumentError, match=r"below each other in a circle: l1 -> l0 -> l5000 -> .* -> l1"):
        parse_urdf(robot(*chain, joint("back", f"l{count}", "l0"), links=links))


@given(
    st.lists(st.sampled_from(["<robot>", "</robot>", "<link name='a'/>", "<joint", " name='j'", ">", "&a;", "<!--"]))
)
def test_whatever_the_text_is_it_is_read_or_refused(parts: list[str]) -> None:
    reason = ""
    try:
        parse_urdf("".join(parts))
    except DocumentError as error:
        reason = str(error)
    assert "\n" not in reason


@pytest.mark.parametrize(
    ("inner", "note"),
    [
        ('<mimic joint="k"/>', "r:3: joint 'j' mimics 'k', which is not there"),
        ('<mimic joint="j"/>', "r:3: joints mimic each other in a circle: j -> j"),
    ],
)
def test_an_odd_mimic_is_noted_and_not_refused(inner: str, note: str) -> None:
    found = parse_urdf(robot(joint("j", "a", "b", inner, "continuous"), links="a b"), "r")
    assert found.notes == (note,)
    assert list(found.joints) == ["j"]


def test_a_robot_inside_of_another_root() -> None:
    text = f"<urdf><other/>{robot(joint('j', 'a', 'b'), links='a b')}</urdf>"
    assert list(parse_urdf(text, anywhere=True).joints) == ["j"]
    with pytest.raises(DocumentError, match="expected <robot>, got <urdf>"):
        parse_urdf(text)
    with pytest.raises(DocumentError, match="expected <robot>, got <urdf>"):
        parse_urdf("<urdf/>", anywhere=True)
