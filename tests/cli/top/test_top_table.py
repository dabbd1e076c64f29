"""Tables and keys of `robolink top`: filtered, sorted, cut to the terminal."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.cli.top.screen import Screen
from robolink.cli.top.table import ORDERS, NodeRow, Shown, TopicRow, View, as_bytes, chosen, lines

NODES = [
    NodeRow(("/world",), 10, 7.2, 65_000_000, 121.0, 64_000.0),
    NodeRow(("/a", "/b", "/c", "/d"), None),
    NodeRow(("/_hidden",), 12, 1.0, 1_000, 1.0, 2.0),
]
TOPICS = [
    TopicRow("/scan", ("sensor_msgs/msg/LaserScan",), 10.0, 15_000.0, 0.05, 3, 1, 2),
    TopicRow("/odom", ("nav_msgs/msg/Odometry", "std_msgs/msg/String"), 50.0, 36_000.0, 0.01, 0, 2, 0),
    TopicRow("/map", ("nav_msgs/msg/OccupancyGrid",)),
]
SHOWN = Shown(NODES, TOPICS)


def names(shown: Shown) -> list[str]:
    return [each.name for each in shown.topics]


@pytest.mark.parametrize(
    ("order", "topics"),
    [
        ("name", ["/map", "/odom", "/scan"]),
        ("rate", ["/odom", "/scan", "/map"]),
        ("lost", ["/scan", "/map", "/odom"]),
        ("age", ["/scan", "/odom", "/map"]),
        ("cpu", ["/map", "/odom", "/scan"]),
    ],
)
def test_an_order_has_the_largest_first_and_the_unknown_last(order: str, topics: list[str]) -> None:
    assert names(chosen(SHOWN, View(order))) == topics


def test_hidden_names_are_shown_on_demand_and_an_order_can_be_turned_around() -> None:
    assert [each.names[0] for each in chosen(SHOWN, View("cpu")).nodes] == ["/world", "/a"]
    assert [each.names[0] for each in chosen(SHOWN, View("name", "", True, True)).nodes] == ["/world", "/a", "/_hidden"]


def test_a_filter_looks_at_names_and_types() -> None:
    assert names(chosen(SHOWN, View(filter="laser"))) == ["/scan"]
    assert [each.names[0] for each in chosen(SHOWN, View(filter="/B")).nodes] == ["/a"]


def test_what_is_not_known_is_a_dash() -> None:
    text = "\n".join(lines(chosen(SHOWN, View()), 7))
    assert text.startswith("domain 7: 5 nodes, 3 topics, 60 messages/s, 51 kB/s, 3 lost\n")
    cells = [line.split() for line in text.splitlines()]
    assert ["/a", "(+3)", *"-----"] in cells
    assert ["/map", "nav_msgs/msg/OccupancyGrid", *"-----", "0", "0"] in cells


@pytest.mark.parametrize(("number", "text"), [(0, "0 B"), (999, "999 B"), (1500, "1.5 kB"), (12e6, "12 MB")])
def test_bytes_have_the_unit_that_suits(number: float, text: str) -> None:
    assert as_bytes(number) == text


def pressed(*keys: str) -> Screen:
    screen = Screen(View(), 0)
    for each in keys:
        screen.press(each)
    return screen


def test_keys_sort_reverse_filter_pause_and_quit() -> None:
    assert pressed("s").view.order == list(ORDERS)[1]
    assert pressed(*"s" * len(ORDERS)).view.order == "name"
    assert pressed("r", "a").view == View(hidden=True, is_reversed=True)
    assert pressed(" ").is_paused
    assert pressed("q").is_done
    assert not pressed("/", "q").is_done
    assert pressed("/", "s", "x", "backspace", "c", "enter", "r").view == View(filter="sc", is_reversed=True)
    assert pressed("/", "s", "escape").view == View()


@given(
    st.integers(1, 200),
    st.integers(1, 60),
    st.lists(st.sampled_from(["down", "pagedown", "up", "s", "home", "/", "x"])),
)
def test_the_screen_has_as_many_lines_as_the_terminal_at_most(columns: int, rows: int, keys: list[str]) -> None:
    many = Shown(NODES * 20, [each._replace(name=f"{each.name}{i}") for i in range(30) for each in TOPICS])
    screen = pressed(*keys)
    written = screen.text(many, columns, rows).split("\n")
    assert len(written) <= max(rows, 3)


@pytest.mark.parametrize("columns", [90, 100, 200])
def test_a_narrow_terminal_shows_every_column(columns: int) -> None:
    name, kind = "/robot_with_a_long_name/camera/image_raw/compressed", "sensor_msgs/msg/CompressedImage"
    shown = Shown([], [TopicRow(name, (kind, kind), 29.9, 1e6, 0.1, publishers=1, subscriptions=3)])
    text = pressed().text(shown, columns, 20)
    header, row = text[text.index("TOPIC") :].replace("\x1b[0m", "").replace("\x1b[K", "").split("\n")[:2]
    assert (header.split()[-1], row.split()[-1], len(row) <= columns) == ("SUBS", "3", True)
    assert (name in row) is (columns == 200)


def test_topics_scroll() -> None:
    many = Shown([], [TopicRow(f"/t{i:02}", ("a/msg/B",)) for i in range(40)])
    screen = pressed(*["down"] * 5)
    text = screen.text(many, 100, 14)
    assert "/t05" in text
    assert "/t04" not in text
    assert "more" in text
