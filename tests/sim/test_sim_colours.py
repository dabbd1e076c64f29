"""Colours of world files: what they are, and what they are told when they are none."""

from __future__ import annotations

import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.sim.colours import NAMES, colour_of, hex_of


@pytest.mark.parametrize(
    ("text", "colour"),
    [
        ("#ff8000", (255, 128, 0)),
        ("#FF8000", (255, 128, 0)),
        ("red", (255, 0, 0)),
        ("Orange", (255, 165, 0)),
        ("grey", (128, 128, 128)),
    ],
)
def test_a_colour_is_hexadecimal_or_a_name(text: str, colour: tuple[int, int, int]) -> None:
    assert colour_of(text) == colour


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (
            "yelow",
            "'yelow' is not a colour (did you mean 'yellow'?): write '#rrggbb' in quotes, or a name such as orange",
        ),
        ("#ff", "'#ff' is not a colour: write"),
        ("#ff00000", "is not a colour"),
        ("#gg0000", "is not a colour"),
        ("ff0000", "is not a colour"),
        ("", "'' is not a colour"),
        ("#ff0000\n", "is not a colour"),
        ("#\u0661\u0661\u0661\u0661\u0661\u0661", "is not a colour"),
    ],
)
def test_what_is_no_colour_is_told_what_is(text: str, expected: str) -> None:
    with pytest.raises(ValueError, match=re.escape(expected)):
        colour_of(text)


@given(st.tuples(*[st.integers(0, 255)] * 3))
def test_any_colour_can_be_written_and_read(colour: tuple[int, int, int]) -> None:
    assert colour_of(hex_of(colour)) == colour


@given(st.text() | st.sampled_from([*NAMES]) | st.from_regex("#[0-9a-fA-F]{5,7}"))
def test_any_text_is_a_colour_or_a_value_error_of_one_line(text: str) -> None:
    try:
        found = colour_of(text)
    except ValueError as error:
        found, refused = (0, 0, 0), str(error)
        assert_shown(refused)
    assert all(0 <= each <= 255 for each in found)


def assert_shown(text: str) -> None:
    assert text.isprintable()
    assert len(text) < 500  # 40 characters, each of which may be shown as ten
