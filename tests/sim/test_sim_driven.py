"""How far robots have driven: there and back alike, sideways where a drive can, and only what they drive themselves."""

from __future__ import annotations

import pytest

from robolink.sim import Pose, Robot, World, load_world
from robolink.sim.driving import fleet


def world(drive: str, more: str = "") -> World:
    text = f"robots: [{{name: r, pose: [0, 0, 0], drive: {{{drive}}}, shape: {{circle: 0.25}}}}]\n{more}"
    return World(load_world("test.yaml", text=text))


def drive(world: World, seconds: float, v: float, w: float = 0.0, sideways: float = 0.0) -> Robot:
    robot = world.robots["r"]
    for _ in range(round(seconds / 0.01)):
        robot.command(v, w, sideways)
        world.step()
    return robot


def test_the_way_there_and_back_counts_twice() -> None:
    made = world("type: diff, a_max: 500")
    drive(made, 2.0, 0.4)
    robot = drive(made, 2.0, -0.4)
    assert robot.pose.x == pytest.approx(0.0, abs=0.01)
    assert robot.driven == pytest.approx(1.6, abs=0.02)


def test_turning_on_the_spot_is_no_way() -> None:
    assert drive(world("type: diff"), 2.0, 0.0, 1.0).driven == pytest.approx(0.0, abs=1e-9)


def test_an_omni_drive_also_drives_sideways() -> None:
    robot = drive(world("type: omni, v_max: 1, a_max: 500"), 2.0, 0.3, 0.0, 0.4)
    assert robot.driven == pytest.approx(1.0, abs=0.01)


def test_being_put_elsewhere_is_no_way() -> None:
    made = world("type: diff")
    made.robots["r"].teleport(Pose(3.0, 0.0, 0.0))
    assert drive(made, 1.0, 0.0).driven == 0.0


def test_who_pushes_against_a_wall_does_not_drive() -> None:
    made = world("type: diff", "walls: [{polyline: [[1, -2], [1, 2]]}]")
    before = drive(made, 5.0, 0.5).driven
    assert before == pytest.approx(0.75, abs=0.02)
    assert drive(made, 5.0, 0.5).driven - before < 0.01


def test_many_robots_drive_as_far_as_each_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    kinds = ("type: diff", "type: omni", "type: ackermann, wheelbase: 0.2")
    robots = "\n".join(
        f"  - {{name: r{n}, pose: [{n}, 0, 1.5], drive: {{{kinds[n % 3]}}}, shape: {{circle: 0.2}}}}" for n in range(6)
    )

    def ways(many: int) -> list[float]:
        monkeypatch.setattr(fleet, "MANY", many)
        made = World(load_world("test.yaml", text=f"robots:\n{robots}"))
        for step in range(200):
            for number, robot in enumerate(made.robots.values()):
                robot.command(0.05 + 0.1 * number, 0.3, 0.1 if step % 2 else -0.1)
            made.step()
        return [robot.driven for robot in made.robots.values()]

    assert ways(1) == ways(100)
    assert all(way > 0.0 for way in ways(1))
