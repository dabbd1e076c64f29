"""`robolink bag record` as a process: signals end it in order, and after a kill the bag opens as it is."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from robolink import Context, Node
from robolink.bag.reader import open_bag
from robolink.interfaces.std_msgs.msg import Int32
from robolink.transport.zenoh import ZenohTransport
from tests.support.bag_kills import kills
from tests.support.programs import Program
from tests.support.waits import wait_until

pytestmark = pytest.mark.processes

RECORDER = """
import sys
from robolink.cli.main import main
sys.exit(main())
"""


@pytest.mark.parametrize("signal", ["interrupt", "terminate"])
def test_a_signal_closes_the_bag_whole_with_all_that_came(signal: str, tmp_path: Path, domain: int) -> None:
    if sys.platform == "win32" and signal == "terminate":
        pytest.skip("Windows has no SIGTERM that a program could catch")
    bag = tmp_path / "bag"
    context = Context(transport=ZenohTransport(domain, environ={}))
    context.init([], domain_id=domain)
    with context:
        publisher = Node("talker", context=context).create_publisher(Int32, "/count", 10)
        words = ["bag", "record", "-a", "-o", str(bag), "--repeat-transient-local", "/map"]
        with Program(tmp_path, RECORDER, domain, *words) as recorder:
            wait_until(lambda: publisher.get_subscription_count() == 1)
            wait_until(lambda: publisher._outlets._all[0].matched)
            for number in range(100):
                publisher.publish(Int32(data=number))
            wait_until(lambda: _count(bag) > 0)
            getattr(recorder, signal)()
            assert recorder.end() == 0, recorder.errors
            assert recorder.line().startswith(f"{bag}: ")
    assert _count(bag) == 100
    with open_bag(bag) as opened:
        assert opened.is_whole
    assert any("Recording stopped" in each for each in recorder.errors)


def _count(bag: Path) -> int:
    if not (bag / "metadata.yaml").exists():
        return 0
    with open_bag(bag) as opened:
        return opened.counts.get("/count", 0)


def test_after_a_kill_all_readers_open_the_bag_as_it_is() -> None:
    for each in kills(3, seed=5, longest=1.0):
        assert set(each.counts.values()) == {each.counts["robolink"]}, each
        assert each.lost < 3.0  # what is lost on a quiet machine: python -m tests.support.bag_kills
