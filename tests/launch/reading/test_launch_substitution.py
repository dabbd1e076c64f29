"""`{name}` in a text becomes what it stands for; braces around anything else stay."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.launch.reading.section import Renamed, SubstitutionError, Value, Values, filled

VALUES = Values({"i": Value(3, "03"), "on": Value(True, "on"), "l": Value.of([1, "a"])}, {"HOME": "/home/me", "i": "x"})

TEXTS = st.text(st.characters(exclude_categories=["Cs"]))


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("{i}", 3),
        (" {i}", " 03"),
        ("{ i }", 3),
        ("a{i}b{i}", "a03b03"),
        ("{on}/{l}", 'on/[1, "a"]'),
        ("{l}", [1, "a"]),
        ("{env:HOME}", "/home/me"),
        ("{env:HOME}/x", "/home/me/x"),
        ("{{i}}", "{i}"),
        ("{{{i}}}", "{03}"),
        ('{"a": {"b": {i}}}', '{"a": {"b": 03}}'),
        ("{linear: {x: 0.5}}", "{linear: {x: 0.5}}"),
        ("{}", "{}"),
        ("a{2,3}", "a{2,3}"),
        ("{1}", "{1}"),
        ("}{", "}{"),
        ("$PATH ${x y}", "$PATH ${x y}"),
    ],
)
def test_names_are_filled_in(text: str, expected: object) -> None:
    assert filled(text, VALUES, []) == expected
    assert filled(text, VALUES, [], as_text=True) == (
        expected if isinstance(expected, str) else filled(f"{text}", VALUES, [], as_text=True)
    )
    assert isinstance(filled(text, VALUES, [], as_text=True), str)


def test_where_only_texts_can_stand_a_number_is_as_it_was_written() -> None:
    assert filled(["{i}", {"{i}": "{i}"}], VALUES, [], as_text=True) == ["03", {"03": "03"}]


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("{j}", "nothing is called '{j}' here, only {i}, {on}, {l}; '{{' and '}}' are braces"),
        ("{HOME}", "nothing is called '{HOME}' here: for the environment's write {env:HOME}"),
        ("{env:HOM}", "the environment has no 'HOM' (did you mean 'HOME'?)"),
        ("{{a}", "a lone '}': write '}}' for one"),
        ("{{a}} {", "a lone '{': write '{{' for one"),
        ("{{a}} {x: 1}", "nothing is called '{x: 1}' here, only {i}, {on}, {l}; '{{' and '}}' are braces"),
    ],
)
def test_what_stands_for_nothing_is_refused(text: str, reason: str) -> None:
    with pytest.raises(SubstitutionError) as caught:
        filled({"a": [0, text]}, VALUES, ["b"])
    assert (str(caught.value), caught.value.steps, caught.value.is_key) == (reason, ["b", "a", 1], False)


def test_keys_are_filled_in_and_remembered() -> None:
    renamed: Renamed = {}
    assert filled({"a{i}": {"{i}": 1}}, VALUES, ["x"], renamed=renamed) == {"a03": {"03": 1}}
    assert renamed == {("x", "a03"): "a{i}", ("x", "a{i}", "03"): "{i}"}
    with pytest.raises(SubstitutionError, match="another key is '03', too") as caught:
        filled({"{i}": 1, "03": 2}, VALUES, [])
    assert (caught.value.steps, caught.value.is_key) == (["03"], True)


@given(TEXTS)
def test_any_text_is_filled_or_refused(text: str) -> None:
    doubled = text.replace("{", "{{").replace("}", "}}")
    if "{" in text:
        assert filled([doubled], VALUES, []) == [text]
        assert filled({doubled: "{i}"}, VALUES, []) == {text: 3}
    try:
        result = filled(text, VALUES, [])
    except SubstitutionError:
        assert "{" in text
    else:
        assert result == text or "{" in text


@given(TEXTS)
def test_values_arrive_as_they_are(text: str) -> None:
    values = Values({"a": Value.of(text)})
    assert filled("{a}", values, []) == filled("{a}", values, [], as_text=True) == text
    assert filled("<{a}>", values, []) == f"<{text}>"
