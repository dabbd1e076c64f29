"""Tracks of checks: the robot's path as it was, contacts at their time, and a size that has a bound."""

from __future__ import annotations

from pathlib import Path

import pytest

from robolink.learn.checking import check
from robolink.learn.exercise import chosen, read_course
from robolink.learn.report import Report

SOLUTIONS = Path(__file__).parent / "solutions"
COURSE = read_course()


def given(name: str, folder: Path) -> Report:
    exercise = chosen(COURSE, name)
    file = folder / exercise.file
    file.write_text(exercise.given_text("en"), encoding="utf-8")
    return check(exercise, file)


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Report:
    """Report of a robot that drives into a wall."""
    return given("stop", tmp_path_factory.mktemp("whole"))


@pytest.mark.slow
def test_a_robot_that_hits_a_wall_is_seen_to_do_so(whole: Report) -> None:
    track = whole.track
    assert track is not None
    (robot,) = track.bodies
    assert robot.is_robot
    assert len(robot.path) // 3 == 200
    begin, end = robot.path[:3], robot.path[-3:]
    assert begin == pytest.approx([1.03, 0.5, 0.0], abs=0.05)
    assert end[0] == pytest.approx(5.0 - robot.circle, abs=0.02)
    (contact,) = track.contacts
    assert contact.at == pytest.approx(12.9, abs=0.3)
    assert (contact.x, contact.y) == pytest.approx((end[0], end[1]), abs=0.02)
    assert (5.0, 0.0, 5.0, 1.0) in track.walls or (5.0, 1.0, 5.0, 0.0) in track.walls


@pytest.mark.slow
def test_a_long_run_is_thinned(whole: Report, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr("robolink.learn.report.MOST_POSES", 60)
    thin = given("stop", tmp_path).track
    assert whole.track is not None
    assert thin is not None
    (robot,), (thinned,) = whole.track.bodies, thin.bodies
    assert 30 <= len(thinned.path) // 3 <= 60
    every = round(thin.period / whole.track.period)
    assert every in (4, 8)
    assert thinned.path[3:6] == robot.path[3 * every : 3 * every + 3], "the same place at the same time"
    assert thin.contacts[0].at == pytest.approx(whole.track.contacts[0].at, abs=thin.period)


@pytest.mark.slow
def test_two_robots_and_none(tmp_path: Path) -> None:
    exercise = chosen(COURSE, "two_robots")
    report = check(exercise, SOLUTIONS / exercise.file)
    assert report.track is not None
    assert [each.name for each in report.track.bodies if each.is_robot] == ["ada", "bob"]
    assert given("hello", tmp_path).track is None


@pytest.mark.slow
def test_a_world_that_cannot_be_looked_at_changes_no_result(
    whole: Report, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def broken(*_: object) -> None:
        raise RuntimeError("no")

    monkeypatch.setattr("robolink.learn.report._Path.add", broken)
    report = given("stop", tmp_path)
    assert report.lines == whole.lines
    assert report.mistake is None
