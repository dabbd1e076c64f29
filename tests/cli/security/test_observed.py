"""`security generate_policy`: the policy of the nodes that run lets them do what they do, and tell their losses."""

from __future__ import annotations

from pathlib import Path

import pytest

from robolink.cli.main import main
from robolink.interfaces.std_msgs.msg import Int32
from robolink.security.policy import Rule, load
from tests.support.seen_by_commands import a_node_that_commands_see


def test_a_policy_allows_what_nodes_do_and_their_reports_of_losses(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    policy = tmp_path / "policy.xml"
    with a_node_that_commands_see(monkeypatch) as robot:
        robot.create_publisher(Int32, "/count", 10)
        assert main(["security", "generate_policy", str(policy)]) == 0
        [[profile]] = load(policy).values()
        assert Rule("publish", True, "/count") in profile.rules
        assert Rule("publish", True, "/diagnostics") not in profile.rules, "it hears nothing, and so loses nothing"
        robot.create_subscription(Int32, "/heard", print, 10)
        assert main(["security", "generate_policy", str(policy)]) == 0
    [[profile]] = load(policy).values()
    assert Rule("subscribe", True, "/heard") in profile.rules
    assert Rule("publish", True, "/diagnostics") in profile.rules
