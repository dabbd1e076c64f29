"""Watch over the fit of scans: when a robot seems to be elsewhere."""

from __future__ import annotations

from robolink.navigation.fit_watch import FitWatch


def noted(watch: FitWatch, *fits: float) -> list[bool]:
    found = []
    for each in fits:
        watch.note(each)
        found.append(watch.is_bad)
    return found


def test_scans_that_fit_much_worse_for_a_while_are_noticed() -> None:
    watch = FitWatch()
    assert noted(watch, *[0.9, 0.8, 1.0] * 10) == [False] * 30
    assert noted(watch, 0.2, 0.9, 0.9, 0.9) == [False] * 4
    assert True in noted(watch, 0.5, 0.5, 0.5, 0.5, 0.5)
    assert noted(watch, *[0.5] * 1000)[-1]  # it does not become usual


def test_a_fit_that_is_bad_from_the_beginning_is_noticed() -> None:
    assert noted(FitWatch(), *[0.3] * 6) == [False] * 4 + [True] * 2


def test_a_map_that_is_wrong_in_places_is_no_alarm() -> None:
    assert noted(FitWatch(), *[0.6, 0.7] * 20) == [False] * 40
    assert noted(FitWatch(), *[0.95] * 20, *[0.75] * 20) == [False] * 40


def test_after_a_new_beginning_it_takes_a_while_again() -> None:
    watch = FitWatch(slow=0.001, fast=0.1)
    assert noted(watch, *[1.0] * 20, *[0.2] * 5)[-1]
    watch.begin_again()
    assert noted(watch, 0.2, 0.2) == [False, False]
    assert noted(watch, *[0.2] * 5)[-1]
