"""Locks: what one thread undeclares and another one asks for at the same time holds up neither."""

from __future__ import annotations

import subprocess
import sys

import pytest

ASKS_BESIDE = """
import threading

import zenoh

from robolink.transport import zenoh_declare as declare
from robolink.qos import DurabilityPolicy, QoSProfile, resolved

config = zenoh.Config()
config.insert_json5("scouting/multicast/enabled", "false")
config.insert_json5("listen/endpoints", "[]")
session = zenoh.open(config)
latched = resolved(QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL))
ends = threading.Event()


def churn():
    while not ends.is_set():
        declare.declare_subscriber(session, "a/b", lambda sample: None, latched).undeclare()


thread = threading.Thread(target=churn)
thread.start()
for _ in range(2000):
    look = declare.declare_look(session, "@ros2_lv/**")
    question = declare.ask(session, "@ros2_lv/**", 5.0)
    while not declare.is_over(question):
        pass
    look.undeclare()
ends.set()
thread.join()
declare.close_session(session)
print("done")
"""


@pytest.mark.processes
def test_a_look_at_the_graph_goes_on_while_a_latched_subscription_ends() -> None:
    command = [sys.executable, "-X", "faulthandler", "-c", ASKS_BESIDE]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
    assert (done.stdout, done.returncode) == ("done\n", 0), done.stderr
