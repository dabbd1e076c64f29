"""Options that take several values in a row, as in ros2."""

from __future__ import annotations

from robolink.cli.shared.noun import repeated

FLAGS = ["--topics", "-x"]


def test_a_flag_is_repeated_before_each_of_its_values() -> None:
    assert repeated(["a", "--topics", "/a", "/b", "-o", "bag", "c"], FLAGS) == (
        ["a", "--topics", "/a", "--topics", "/b", "-o", "bag", "c"]
    )


def test_other_flags_and_values_behind_an_equals_sign_stay() -> None:
    words = ["--all", "--topics=/a", "/b", "-o", "-x"]
    assert repeated(words, FLAGS) == words


def test_a_flag_without_a_value_is_left_for_the_parser_to_refuse() -> None:
    assert repeated(["--topics", "--all"], FLAGS) == ["--topics", "--all"]
    assert repeated(["-x"], FLAGS) == ["-x"]


def test_behind_two_dashes_nothing_is_a_flag() -> None:
    assert repeated(["--topics", "/a", "--", "--topics", "/b"], FLAGS) == ["--topics", "/a", "--", "--topics", "/b"]
