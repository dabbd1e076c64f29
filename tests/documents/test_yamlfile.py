"""YAML is read as people mean it, and every mistake in it is one line that says where."""

from __future__ import annotations

import math
import tempfile
from pathlib import Path
from typing import Any, Literal

import msgspec
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from robolink.documents import yamltext
from robolink.documents.yamlfile import DocumentNotFoundError, load, mistakes, parse, read, spell
from robolink.exceptions import DocumentError


class Robot(msgspec.Struct, forbid_unknown_fields=True):
    name: str
    speed: float = 0.5
    count: int = 1
    pose: list[float] = []

    def __post_init__(self) -> None:
        if self.count > 9:
            raise ValueError("at most 9 of a kind")


class World(msgspec.Struct, forbid_unknown_fields=True):
    robots: list[Robot] = []
    zones: dict[str, Robot | None] = {}
    rates: dict[int, float] = {}
    title: str | None = None


PEOPLE_MEAN = [
    ("on", "on"),
    ("off", "off"),
    ("yes", "yes"),
    ("no", "no"),
    ("y", "y"),
    ("true", True),
    ("False", False),
    ("012", 12),
    ("-7", -7),
    ("0x1F", 31),
    ("0o17", 15),
    ("1e3", 1000.0),
    ("1.", 1.0),
    (".5", 0.5),
    ("-.inf", -math.inf),
    ("12:30:00", "12:30:00"),
    ("2024-05-01", "2024-05-01"),
    ("1_000", "1_000"),
    ("=", "="),
    ("~", None),
    ("", None),
    ("'12'", "12"),
    ("!!str 12", "12"),
    ("!!float 3", 3.0),
    ("{on: 1, 2: b, ~: c}", {"on": 1, "2": "b", "~": "c"}),
    ("[1, [2, {a: }]]", [1, [2, {"a": None}]]),
    ("- &a {x: 1}\n- *a", [{"x": 1}, {"x": 1}]),
    ("- &a {x: 1, y: 1}\n- {<<: *a, y: 2}", [{"x": 1, "y": 1}, {"x": 1, "y": 2}]),
    ("- &a {x: 1}\n- &b {x: 2, y: 2}\n- {<<: [*a, *b]}", [{"x": 1}, {"x": 2, "y": 2}, {"x": 1, "y": 2}]),
]


@pytest.mark.parametrize(("text", "meant"), PEOPLE_MEAN)
def test_scalars_are_read_as_people_mean_them(text: str, meant: object) -> None:
    found = parse(text)
    assert found == meant
    assert type(found) is type(meant)


BILLION = "a: &a [x,x,x,x,x,x,x,x,x,x]\n" + "".join(
    f"{this}: &{this} [{','.join(['*' + last] * 10)}]\n" for last, this in zip("abcdefgh", "bcdefghi", strict=True)
)
NOT_YAML = [
    ("a:\n\t- 1", "x:2:1: a tab where only spaces may stand"),
    ("a: b: c", "x:1:5: a second ': ' in one value, or a key that is indented wrongly"),
    ("a: [1, 2", "x:1:9: expected ',' or ']', but got the end of the text"),
    ("a: 'b", "x:1:6: a quote is opened and never closed"),
    ("- a\nb: 1", "x:2:1: this does not go on with the block above it"),
    ("a: *b", "x:1:4: found undefined alias 'b'"),
    ("a: @b", "x:1:4: a plain value cannot begin with '@'"),
    ("a: 1\n---\nb: 2", "x:2:1: a second document begins here"),
    ("a: 1\nb: 2\na: 3", "x:3:1: key 'a' is given twice, first in line 1"),
    ("a: \x07", "x:1:4: character U+0007 is not allowed in YAML"),
    ('a: "\\UFFFFFFFF"', "x:1:7: "),
    ('a: "\\ud800"', "x:1:4: half a surrogate pair is not a character"),
    ("a: !!python/name:os.system x", "x:1:4: unknown tag '!!python/name:os.system'"),
    ("a: !robot {}", "x:1:4: unknown tag '!robot'"),
    ("a: !!int b", "x:1:4: 'b' is not an int"),
    ("a: " + "9" * 5000, "x:1:4: '999"),
    ("{[1]: 2}", "x:1:2: a key must be a word, got a list"),
    ("<<: 1", "x:1:5: '<<' can merge only mappings"),
    ("&a {<<: *a}", "x:1:1: '<<' merges a mapping into itself"),
    ("&a [*a]", "x:1:1: nested more than 64 levels deep by aliases"),
    ("[" * 1000, "x:1:64: nested more than 64 levels deep"),
    ("a: " * 3, "x:1:5: a second ': '"),
    (BILLION, "x:1:12: aliases repeat more than 100000 values"),
]


@pytest.mark.parametrize(("text", "report"), NOT_YAML)
def test_what_is_no_yaml_is_reported_in_one_line_with_its_place(text: str, report: str) -> None:
    with pytest.raises(DocumentError) as caught:
        parse(text, name="x")
    assert str(caught.value).startswith(report)
    assert "\n" not in str(caught.value)


NOT_A_WORLD = [
    ("robots:\n- name: a\n  spede: 1", "w.yaml:3:3: robots[0].spede: unknown key 'spede' (did you mean 'speed'?)"),
    ("robots: [{name: a, speed: fast}]", "w.yaml:1:27: robots[0].speed: expected float, got 'fast'"),
    ("robots: [{name: a, speed: [1]}]", "w.yaml:1:27: robots[0].speed: expected float, got list"),
    ("robots: [{name: a, count: 1.5}]", "w.yaml:1:27: robots[0].count: expected int, got '1.5'"),
    ("robots: [{name: 7}]", "w.yaml:1:17: robots[0].name: expected str, got '7'"),
    ("robots: [{name: a, speed: }]", "w.yaml:1:26: robots[0].speed: expected float, got nothing"),
    ("robots: [{name: a}, {}]", "w.yaml:1:21: robots[1]: missing key 'name'"),
    ("robots: [{name: a, count: 12}]", "w.yaml:1:10: robots[0]: at most 9 of a kind"),
    ("robots: {name: a}", "w.yaml:1:9: robots: expected list, got mapping"),
    ("zones: {a: {name: b}, c.d: {name: 1}}", "w.yaml:1:35: zones.c.d.name: expected str, got '1'"),
    ("zones: {a: {name: b, sped: 1}}", "w.yaml:1:22: zones.a.sped: unknown key 'sped' (did you mean 'speed'?)"),
    ("rates: {one: 1}", "w.yaml:1:8: rates: a key: expected int, got str"),
    ("rates: {1: 1, 2: x}", "w.yaml:1:18: rates.2: expected float, got 'x'"),
    ("title: [a]", "w.yaml:1:8: title: expected str | nothing, got list"),
    ('"a\\nb": 1', "w.yaml:1:1: a\\nb: unknown key 'a\\nb'; there are robots, zones, rates, title"),
    ("robot: []", "w.yaml:1:1: robot: unknown key 'robot' (did you mean 'robots'?)"),
    ("- 1", "w.yaml:1:1: expected mapping, got list"),
    ("hello", "w.yaml:1:1: expected mapping, got 'hello'"),
    ("", "w.yaml:1:1: expected mapping, got nothing"),
]


@pytest.mark.parametrize(("text", "report"), NOT_A_WORLD)
def test_what_does_not_fit_its_struct_is_reported_in_one_line_with_its_place(text: str, report: str) -> None:
    with pytest.raises(DocumentError) as caught:
        load("w.yaml", World, text=text)
    assert str(caught.value) == report


def test_a_file_becomes_a_struct(tmp_path: Path) -> None:
    path = tmp_path / "world.yaml"
    path.write_text("\ufefftitle: Zürich\nrobots: [{name: a, speed: 2, pose: [1, 2.5]}]\n", encoding="utf-8")
    world = load(path, World)
    assert world == World([Robot("a", 2.0, pose=[1.0, 2.5])], title="Zürich")
    path.write_text("title: Zürich\n", encoding="utf-16")
    assert load(path, World).title == "Zürich"


def test_a_file_that_cannot_be_read_is_one_line(tmp_path: Path) -> None:
    (tmp_path / "wander.yaml").write_bytes(b"ok\na: \xff")
    with pytest.raises(DocumentNotFoundError, match=r"no file '.*wandr.yaml' \(did you mean 'wander.yaml'\?\)"):
        load(tmp_path / "wandr.yaml", World)
    with pytest.raises(FileNotFoundError):
        load(tmp_path / "no" / "where.yaml", World)
    with pytest.raises(DocumentError, match=r"wander\.yaml:2:4: not UTF-8 text"):
        load(tmp_path / "wander.yaml", World)
    with pytest.raises(DocumentError, match="cannot be read"):
        load(tmp_path, World)
    with pytest.raises(DocumentError, match="cannot be read"):
        load("a\0b", World)


def test_a_file_without_end_is_given_up(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "long.yaml").write_bytes(b"#" * 2**20)
    monkeypatch.setattr(yamltext, "MAX_BYTES", 2**20)
    with pytest.raises(DocumentError, match=r"1:1: expected mapping, got nothing"):
        load(tmp_path / "long.yaml", World)
    monkeypatch.setattr(yamltext, "MAX_BYTES", 2**20 - 1)
    with pytest.raises(DocumentError, match=r"long\.yaml: cannot be read: it is longer than 1\.04858 MB"):
        load(tmp_path / "long.yaml", World)


def test_a_document_places_errors_that_are_found_later() -> None:
    document = read("w.yaml", World, text="robots:\n- name: a\n  pose: [1, 2]\nzones:\n  c.d: {name: b}\n")
    assert str(document.error("$.robots[0].pose", "too short")) == "w.yaml:3:9: robots[0].pose: too short"
    assert str(document.error("$.robots[0].pose", "unused", key=True)) == "w.yaml:3:3: robots[0].pose: unused"
    assert str(document.error("$.robots[0].speed", "too slow")) == "w.yaml:2:3: robots[0].speed: too slow"
    assert str(document.error(["zones", "c.d", "name"], "taken")) == "w.yaml:5:15: zones.c.d.name: taken"
    assert str(document.error('$.zones["c.d"].name', "taken")) == "w.yaml:5:15: zones.c.d.name: taken"
    assert str(document.error("$", "empty")) == "w.yaml:1:1: empty"
    assert str(read("w.yaml", Any, text="").error("$.a", "empty")) == "w.yaml:1:1: a: empty"


data = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(),
    lambda inside: st.lists(inside, max_size=4) | st.dictionaries(st.text(), inside, max_size=4),
    max_leaves=12,
)


@given(data)
@example(["\u2028", "\x85", "\ufeff", "\x7f", "a\\\"'", " ", "😀", "<<"])
@example({"<<": 1, "": 2, "on": 1e300, "x": 5e-324})
def test_what_is_spelled_is_read_back_exactly(value: Any) -> None:
    assert repr(parse(spell(value))) == repr(value)
    assert "\n" not in spell(value)


yaml_like = st.lists(
    st.sampled_from(["a", "1", ": ", "- ", "\n", " ", "[", "]", "{", "}", ",", "? ", "&a ", "*a", "<<", "!!", "!", "%"])
    | st.sampled_from(["#", "|", ">", "'", '"', "\\", "\t", "---", "...", "0x", "~", "@", "%YAML 1.2\n", "\r", "\x85"]),
    max_size=25,
).map("".join)


@given(st.text() | yaml_like)
@example("%YAML 1.\u0661")
@example("a: !<!> b")
def test_random_text_raises_nothing_but_document_errors(text: str) -> None:
    report = report_of("w.yaml", text)
    assert report == "" or report.startswith("w.yaml:")
    assert "\n" not in report


@given(st.binary() | st.text().map(str.encode))
def test_random_bytes_raise_nothing_but_document_errors(content: bytes) -> None:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "w.yaml"
        path.write_bytes(content)
        report = report_of(path)
        assert report == "" or report.startswith(str(path))


def report_of(path: str | Path, text: str | None = None) -> str:
    try:
        assert isinstance(load(path, World, text=text), World)
    except DocumentError as error:
        return str(error)
    return ""


# --- values whose type their keys tell ------------------------------------------------------------------------


class Part:
    """Something that msgspec does not know."""

    __slots__ = ()


class Arm(Part, msgspec.Struct, forbid_unknown_fields=True):
    arm: str
    reach: float = 1.0


class Box(Part, msgspec.Struct, forbid_unknown_fields=True):
    box: tuple[float, float]
    inside: list[Part] = []


class Machine(msgspec.Struct, forbid_unknown_fields=True):
    parts: list[Part] = []
    named: dict[str, Part] = {}
    spare: Part | None = None
    kind: Literal["big", "small"] = "big"


def kind_of_part(type_: type, data: Any) -> type[Part]:
    kinds: dict[str, type[Part]] = {"arm": Arm, "box": Box}
    for key, kind in kinds.items():
        if key in data:
            return kind
    raise ValueError("neither an arm nor a box")


def test_a_hook_chooses_the_type_by_the_data() -> None:
    text = (
        "parts: [{arm: left}, {box: [1, 2], inside: [{arm: hidden, reach: 2}]}]\nspare: {arm: x}\nnamed: {a: {arm: y}}"
    )
    machine = read("m.yaml", Machine, text=text, hook=kind_of_part).value
    assert machine.parts == [Arm("left"), Box((1.0, 2.0), [Arm("hidden", 2.0)])]
    assert (machine.spare, machine.named) == (Arm("x"), {"a": Arm("y")})


NOT_A_MACHINE = [
    ("parts: [{arm: a, reech: 2}]", "m.yaml:1:18: parts[0].reech: unknown key 'reech' (did you mean 'reach'?)"),
    ("parts: [{arm: a, reach: far}]", "m.yaml:1:25: parts[0].reach: expected float, got 'far'"),
    ("parts: [{arm: a}, {leg: b}]", "m.yaml:1:19: parts[1]: neither an arm nor a box"),
    ("spare: {arm: 3}", "m.yaml:1:14: spare.arm: expected str, got '3'"),
    ("named: {a: {arm: b}, c: {arm: 4}}", "m.yaml:1:31: named.c.arm: expected str, got '4'"),
    ("named: {a: {box: [1, 2]}, c: {box: [1]}}", "m.yaml:1:36: named.c.box: expected list of length 2, got 1"),
    (
        "parts: [{box: [1, 2], inside: [{arm: a}, {arm: b, reach: x}]}]",
        "m.yaml:1:58: parts[0].inside[1].reach: expected float, got 'x'",
    ),
    ("kind: bigg", "m.yaml:1:7: kind: expected one of big, small, got 'bigg' (did you mean 'big'?)"),
]


@pytest.mark.parametrize(("text", "report"), NOT_A_MACHINE)
def test_an_error_inside_of_what_the_hook_chose_has_its_place(text: str, report: str) -> None:
    with pytest.raises(DocumentError) as caught:
        read("m.yaml", Machine, text=text, hook=kind_of_part)
    assert str(caught.value) == report
    assert [str(each) for each in mistakes("m.yaml", Machine, text=text, hook=kind_of_part)] == [report]


def test_all_mistakes_are_found_at_once() -> None:
    text = (
        "robots: [{name: 1, pose: [1, x, y]}, {nme: b}]\nzones: {a: {name: c, sped: 1}}\nrates: {1: fast, 2: 2}\nx: 1"
    )
    assert [str(each).partition(": ")[2] for each in mistakes("w.yaml", World, text=text)] == [
        "robots[0].name: expected str, got '1'",
        "robots[0].pose[1]: expected float, got 'x'",
        "robots[0].pose[2]: expected float, got 'y'",
        "robots[1].nme: unknown key 'nme' (did you mean 'name'?)",
        "zones.a.sped: unknown key 'sped' (did you mean 'speed'?)",
        "rates.1: expected float, got 'fast'",
        "x: unknown key 'x'; there are robots, zones, rates, title",
    ]
    assert [str(each) for each in mistakes("w.yaml", World, text="a: [")] == [report_of("w.yaml", "a: [")]
    assert mistakes("w.yaml", World, text="robots: [{name: a}]") == []


@given(st.text() | yaml_like | data.map(spell))
def test_there_are_mistakes_where_reading_fails_and_only_there(text: str) -> None:
    found = [str(each) for each in mistakes("w.yaml", World, text=text)]
    assert bool(found) == bool(report_of("w.yaml", text))
    assert all(each.startswith("w.yaml:") and "\n" not in each for each in found)
