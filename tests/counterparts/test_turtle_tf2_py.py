"""turtle_tf2_py: the introduction to tf2, in which a turtle follows another one, in virtual time."""

from __future__ import annotations

import math

import pytest

from robolink.interfaces.geometry_msgs.msg import Twist, Vector3
from robolink.testing import System


def distance(system: System) -> float:
    """Metres between the two turtles."""
    one, two = (system.expect(f"/turtle{n}/pose", within=0.5) for n in (1, 2))
    return math.dist((one.x, one.y), (two.x, two.y))


@pytest.mark.slow
def test_a_turtle_follows_another(system: System) -> None:
    system.launch("turtle_tf2_py turtle_tf2_demo.launch.py")
    system.expect_log("Successfully spawned turtle2")
    assert set(system.nodes) == {"/sim", "/broadcaster1", "/broadcaster2", "/listener"}
    system.run(12.0)
    assert distance(system) < 0.5
    system.publish("/turtle1/cmd_vel", Twist(linear=Vector3(x=2.0)))
    system.run(1.5)
    assert 0.5 < distance(system) < 2.1


@pytest.mark.slow
def test_without_turtlesim_it_waits(system: System) -> None:
    system.start("turtle_tf2_py turtle_tf2_listener", parameters={"target_frame": "turtle3"})
    system.expect_log("Service is not ready")
    system.start("turtlesim turtlesim_node")
    system.start("turtle_tf2_py turtle_tf2_broadcaster", parameters={"turtlename": "turtle2"})
    system.expect_log("Successfully spawned turtle2")
    system.expect_log("Could not transform turtle2 to turtle3: ")
