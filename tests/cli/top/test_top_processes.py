"""`robolink top` in a process of its own, beside a node in another: with its CPU and memory, and on a terminal."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Iterator

import pytest

from tests.support.commands import ROBOLINK, TERMINAL, Command

pytestmark = pytest.mark.processes

TALKER = """
import robolink
from robolink.interfaces.std_msgs.msg import String

robolink.init()
node = robolink.create_node("talker")
publisher = node.create_publisher(String, "said", 10)
node.create_timer(0.02, lambda: publisher.publish(String(data="hello")))
print("talks")
robolink.spin(node)
"""


@pytest.fixture
def talker(domain: int) -> Iterator[Command]:
    with Command(domain, program=(sys.executable, "-c", TALKER)) as command:
        command.wait_for("talks")
        yield command
        command.kill()


def test_once_in_json_has_the_process_of_a_node_and_what_it_sends(talker: Command, domain: int) -> None:
    with Command(domain, "top", "--once", "--json", "--every", "0.5") as top:
        assert top.end() == 0
    found = json.loads(top.lines[0].text)
    (node,) = found["nodes"]
    assert (node["names"], node["pid"]) == (["/talker"], talker.process.pid)
    assert node["memory"] > 1_000_000
    assert node["cpu"] is not None
    said = next(each for each in found["topics"] if each["name"] == "/said")
    assert said["types"] == ["std_msgs/msg/String"]
    assert 5 < said["rate"] < 60
    assert said["lost"] == 0


@pytest.mark.skipif(sys.platform == "win32", reason="there are no pseudo-terminals as these")
def test_on_a_terminal_it_shows_at_once_and_q_ends_it(talker: Command, domain: int) -> None:
    program = (sys.executable, "-c", TERMINAL, *ROBOLINK)
    with Command(domain, "top", program=program, has_input=True, merged=True) as top:
        top.wait_for("/said")
        top.press("/nothing\rr")  # the last line comes with the next screen
        top.wait_for("filter 'nothing'")
        top.press("q")
        assert top.end() == 0


def test_an_unknown_order_is_refused_with_the_nearest() -> None:
    done = subprocess.run(
        [*ROBOLINK, "top", "--sort", "rat"], capture_output=True, text=True, check=False, env=dict(os.environ)
    )
    assert done.returncode == 2
    assert "did you mean 'rate'" in done.stderr
    assert len(done.stderr.splitlines()) == 1
