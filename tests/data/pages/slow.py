"""A test of a page about failures: it fails."""

from robolink.testing import System


def test_follows(system: System) -> None:
    system.launch("follow")
    system.faults.lose("scan", 0.2)
    system.run(60.0)
    system.expect("cmd_vel", lambda twist: twist.linear.x > 1.0, within=1.0)
