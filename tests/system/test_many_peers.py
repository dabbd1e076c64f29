"""A session that has just been opened lists every token of a large system, each time."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from contextlib import ExitStack
from typing import NamedTuple

import pytest

from robolink.transport import zenoh_handles
from robolink.transport.zenoh import ZenohTransport
from tests.support.domains import free_domain

pytestmark = pytest.mark.processes

PROCESSES, SESSIONS, NODES, TOPICS, LOOKS = 5, 4, 30, 200, 4

PROGRAM = """
import sys, time
from robolink.transport import zenoh
from robolink.transport.zenoh import ZenohTransport
zenoh.LINK_WITHIN = 30.0
sessions = [ZenohTransport(int(sys.argv[1]), environ={}) for _ in range(int(sys.argv[2]))]
for number, token in enumerate(sys.argv[4:]):
    sessions[number % len(sessions)].announce(token)
while any(len(session._peers()) < int(sys.argv[3]) - 1 for session in sessions):
    time.sleep(0.01)
print("ready", flush=True)
sys.stdin.read()
"""


def all_tokens(domain: int) -> list[str]:
    """Those of the nodes and those of a publisher for each topic."""
    nodes = [f"@ros2_lv/{domain}/a/{number}/{number}/NN/%/%/node_{number}" for number in range(NODES)]
    type_ = f"std_msgs::msg::dds_::String_/RIHS01_{'0' * 64}/::,10:,:,:,,"
    return nodes + [
        f"@ros2_lv/{domain}/a/{topic % NODES}/{NODES + topic}/MP/%/%/node_{topic % NODES}/%topic_{topic}/{type_}"
        for topic in range(TOPICS)
    ]


class System(NamedTuple):
    """A domain, and what is announced on it."""

    domain: int
    tokens: list[str]


@pytest.fixture(scope="module")
def system() -> Iterator[System]:
    """Twenty sessions in several processes, each linked to all, that announce a part of the tokens each."""
    with free_domain() as domain, ExitStack() as stack:
        tokens = all_tokens(domain)
        started = []
        for number in range(PROCESSES):
            counts = str(SESSIONS), str(SESSIONS * PROCESSES)
            command = [sys.executable, "-c", PROGRAM, str(domain), *counts, *tokens[number::PROCESSES]]
            process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
            stack.enter_context(process)
            stack.callback(process.kill)
            started.append(process)
        for process in started:
            assert process.stdout
            assert process.stdout.readline() == "ready\n"
        yield System(domain, sorted(tokens))


@pytest.fixture(autouse=True)
def _quiet(patient_looks: None, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(zenoh_handles, "QUIET", 1.0)  # a busy machine takes its time for twenty links


def test_each_look_lists_all(system: System) -> None:
    looks = []
    for _ in range(LOOKS):
        session = ZenohTransport(system.domain, environ={})
        looks.append(session.tokens(f"@ros2_lv/{system.domain}/**"))
        session.close()
    # On a machine that does ten times too much, one may know nobody but the port's holder for more than a second.
    assert sum(look == system.tokens for look in looks) >= LOOKS - 1, [len(look) for look in looks]


def test_a_look_right_after_others_have_come(system: System) -> None:
    sessions = [ZenohTransport(system.domain, environ={}) for _ in range(5)]
    own = [f"@ros2_lv/{system.domain}/b/{number}/{number}/NN/%/%/late_{number}" for number in range(5)]
    for session, token in zip(sessions, own, strict=True):
        session.announce(token)
    looking = [ZenohTransport(system.domain, environ={}) for _ in range(2)]
    sessions += looking
    try:
        looks = [each.tokens(f"@ros2_lv/{system.domain}/**") for each in looking]
        assert sorted([*system.tokens, *own]) in looks, [len(look) for look in looks]
    finally:
        for session in sessions:
            session.close()
