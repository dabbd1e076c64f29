"""The tables of the benchmark of record are those of its committed file, in each page and in both languages."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from benchmarks.record import pages

ROOT = Path(__file__).parents[2]
FOUND: dict[str, Any] = {
    "date": "2026-11-29",
    "machine": {"cores": 2, "processor": "one", "system": "Linux 6", "python": "3.11", "load": 0.1},
    "versions": {"robolink": {"python": "3.11", "robolink": "0.2", "commit": "abc"}, "bare": {"eclipse-zenoh": "1.10"}},
    "missing": {"dora": "dora-rs is not installed"},
    "failed": {"twist": {"sdk": "GameError: no answer"}},
    "rows": {
        "twist": {"robolink": [150.0, 100.0, 120.0], "build": [240.0, 240.0, 240.0], "bare": [60.0, 1500.0, 90.0]},
        "flood-10": {"robolink": [123456.0, 123456.0, 123456.0]},
        "flood-10/lost": {"robolink": [0.25, 0.25, 0.25]},
        "flood-10/wrong": {"robolink": [0.0, 0.0, 2.0]},
    },
    "medians": {
        "twist": {"robolink": 120.0, "build": 240.0, "bare": 90.0},
        "flood-10": {"robolink": 123456.0},
        "flood-10/lost": {"robolink": 0.25},
        "flood-10/wrong": {"robolink": 0.0},
    },
}


@pytest.mark.parametrize("name", pages.PAGES)
def test_the_blocks_of_a_page_are_those_of_the_file(name: str) -> None:
    text = (ROOT / name).read_text(encoding="utf-8")
    found = json.loads((ROOT / "benchmarks" / "record.json").read_text(encoding="utf-8"))
    assert text.count("<!-- record: ") == text.count("<!-- record ends -->") > 0
    assert pages.page(text, found) == text, "python benchmarks/peers.py --write"


def test_a_table_has_medians_and_their_ratio_to_robolinks_without_the_other_build() -> None:
    assert pages.BLOCKS["trips"](FOUND) == (
        "| | robolink | bare Zenoh |\n|---|---|---|\n| round trip of a Twist | 120 us | 90 us (0.75) |\n"
    )


def test_a_flood_says_what_was_lost_and_came_out_of_order() -> None:
    text = pages.BLOCKS["floods"](FOUND)
    assert "| 123,000, 25% lost |" in text
    assert text.endswith("in all rounds: 2 of robolink's.\n")


def test_the_notes_have_every_round_and_what_failed() -> None:
    text = pages.BLOCKS["rounds"](FOUND)
    assert "| bare Zenoh | 90 us | 60 us to 1.50 ms | 0.75 | 0.38 | 1.00 |" in text
    assert "| robolink | 120 us | 100 us to 150 us | 1.00 | 0.50 | 1.33 |" in text
    assert "twist, zenoh-ros2-sdk: GameError: no answer" in text
    assert "dora, dora-rs is not installed" in text


def test_portuguese_has_its_own_words_and_commas() -> None:
    assert pages.BLOCKS["leia-me"](FOUND) == (
        "| | robolink | Zenoh puro |\n|---|---|---|\n| ida e volta de um Twist | 120 us | 90 us |\n"
        f"| Twists recebidos por segundo, depth 10 | 123.000 | {pages.DASH} |\n"
    )


@pytest.mark.parametrize(
    ("figure", "unit", "text"),
    [(999.4, "us", "999 us"), (12_340.0, "us", "12.3 ms"), (0.0271, "%", "2.71 %"), (24.04, "MB", "24.0 MB")],
)
def test_a_figure_has_the_digits_that_mean_something(figure: float, unit: str, text: str) -> None:
    assert pages.shown(figure, unit) == text


def test_what_is_outside_of_the_marks_stays() -> None:
    text = "before\n<!-- record: trips -->\nold\n<!-- record ends -->\nafter\n"
    made = pages.page(text, FOUND)
    assert made.startswith("before\n<!-- record: trips -->\n| |")
    assert made.endswith("|\n<!-- record ends -->\nafter\n")
