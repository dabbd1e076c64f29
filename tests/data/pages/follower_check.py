"""Test of a page: its program follows the line of the world `track`, round two bends."""

from follower import Follower


def test_it_follows_the_line(system):
    system.start("world", parameters={"world": "track"})
    system.start(Follower)
    system.run(30.0)
    robot = system.robot()
    assert robot.pose.x > 4.0
    assert robot.pose.y > 3.5
    assert robot.contacts == 0
