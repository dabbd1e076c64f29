"""The palette of the style sheet: contrast of texts and marks, and colours that colour-blind people tell apart."""

from __future__ import annotations

import itertools
import math
import re
from pathlib import Path

import pytest

import robolink.view

STYLE = Path(str(robolink.view.__file__)).with_name("page").joinpath("style.css").read_text(encoding="utf-8")
GROUNDS = ("bg", "panel", "ground", "field")
TEXTS = ("fg", "dim", "accent", "good", "warn", "bad")
SERIES = tuple(f"c{number}" for number in range(1, 9))
ROLES = ("scan", "path", "local", "particles", "goal", "trail", "camera")
MARKS = (*SERIES, *ROLES, "robot", "axis-x", "axis-y")

Triple = tuple[float, float, float]

SIGHTS: dict[str, tuple[Triple, Triple, Triple]] = {
    "usual": ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)),
    "deuteranopia": ((0.367322, 0.860646, -0.227968), (0.280085, 0.672501, 0.047413), (-0.01182, 0.04294, 0.968881)),
    "protanopia": ((0.152286, 1.052583, -0.204868), (0.114503, 0.786281, 0.099216), (-0.003882, -0.048116, 1.051998)),
}
"""What eyes make of linear red, green and blue (Machado, Oliveira and Fernandes 2009, severity 1.0)."""


def themes() -> dict[str, dict[str, str]]:
    """The variables of each theme, and those that the light one has for a browser's own setting."""
    sets = re.findall(r":root(\S*) \{\n(.*?)\n\}", STYLE, re.DOTALL)
    names = {"": "dark", "[data-theme=light]": "light", ":not([data-theme=dark])": "preferred"}
    return {names[selector]: dict(re.findall(r"--([\w-]+): (#\w+);", text)) for selector, text in sets}


def linear(colour: str) -> Triple:
    """Red, green and blue of "#rrggbb" or "#rgb" without the gamma of sRGB (IEC 61966-2-1)."""
    parts = [int(long_form(colour)[at : at + 2], 16) / 255 for at in (1, 3, 5)]
    red, green, blue = (each / 12.92 if each <= 0.04045 else ((each + 0.055) / 1.055) ** 2.4 for each in parts)
    return red, green, blue


def contrast(one: str, other: str) -> float:
    """Contrast of two colours, 1 to 21 (WCAG 2.2)."""
    low, high = sorted(weighed((0.2126, 0.7152, 0.0722), linear(each)) for each in (one, other))
    return (high + 0.05) / (low + 0.05)


def weighed(weights: Triple, values: Triple) -> float:
    return sum(weight * value for weight, value in zip(weights, values, strict=True))


def oklab(colour: str, sight: str) -> list[float]:
    """Place of a colour in OKLab (Ottosson 2020), as a kind of eyes sees it."""
    seen = [min(1.0, max(0.0, weighed(row, linear(colour)))) for row in SIGHTS[sight]]
    red, green, blue = seen
    cones = (
        (0.4122214708, 0.5363325363, 0.0514459929),
        (0.2119034982, 0.6806995451, 0.1073969566),
        (0.0883024619, 0.2817188376, 0.6299787005),
    )
    long, middle, short = (weighed(row, (red, green, blue)) ** (1 / 3) for row in cones)
    rows = (
        (0.2104542553, 0.7936177850, -0.0040720468),
        (1.9779984951, -2.4285922050, 0.4505937099),
        (0.0259040371, 0.7827717662, -0.8086757660),
    )
    return [weighed(row, (long, middle, short)) for row in rows]


def mixed(one: str, other: str, share: float) -> str:
    """The colour of `share` of one over the other, as color-mix(in srgb) makes it."""
    parts = [[int(each[at : at + 2], 16) for at in (1, 3, 5)] for each in map(long_form, (one, other))]
    return "#" + "".join(f"{round(share * a + (1 - share) * b):02x}" for a, b in zip(*parts, strict=True))


def long_form(colour: str) -> str:
    return colour if len(colour) == 7 else "#" + "".join(2 * each for each in colour[1:])


def test_the_light_theme_is_the_same_by_choice_and_by_the_browser() -> None:
    found = themes()
    assert found["preferred"] == found["light"]
    assert found["dark"].keys() == found["light"].keys()


@pytest.mark.parametrize("theme", ["dark", "light"])
def test_texts_can_be_read_on_each_ground(theme: str) -> None:
    colours = themes()[theme]
    grounds = {name: colours[name] for name in GROUNDS}
    grounds["hovered row"] = mixed(colours["accent"], colours["panel"], 0.15)
    weak = {
        f"{text} on {name}": round(found, 2)
        for text, (name, ground) in itertools.product(TEXTS, grounds.items())
        if (found := contrast(colours[text], ground)) < 4.5
    }
    assert not weak
    assert contrast(colours["panel"], colours["accent"]) >= 4.5, "pressed buttons"
    assert contrast(colours["on-danger"], colours["danger"]) >= 4.5, "STOP"


@pytest.mark.parametrize("theme", ["dark", "light"])
def test_marks_are_seen_on_each_ground(theme: str) -> None:
    colours = themes()[theme]
    pairs = itertools.product(MARKS, GROUNDS)
    weak = [(mark, name) for mark, name in pairs if contrast(colours[mark], colours[name]) < 3.0]
    assert not weak


@pytest.mark.parametrize("theme", ["dark", "light"])
@pytest.mark.parametrize(("names", "least"), [(SERIES, 0.08), (ROLES, 0.065)], ids=["series", "roles"])
def test_colours_can_be_told_apart_by_all_eyes(theme: str, names: tuple[str, ...], least: float) -> None:
    """0.02 is what one just sees between two areas side by side; thin lines that are apart need some times that."""
    colours = themes()[theme]
    alike = [
        (sight, one, other)
        for sight in SIGHTS
        for one, other in itertools.combinations(names, 2)
        if math.dist(oklab(colours[one], sight), oklab(colours[other], sight)) < least
    ]
    assert not alike
