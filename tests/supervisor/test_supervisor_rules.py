"""How ends are called, which are orderly, and how long a restart waits."""

from __future__ import annotations

import pytest

from robolink.supervisor.policy import Say, Step, described, is_orderly
from tests.support.policies import replay, two

INTERRUPT, TERMINATE, KILL = Step.INTERRUPT, Step.TERMINATE, Step.KILL


@pytest.mark.parametrize(
    ("returncode", "words"),
    [
        (0, "has ended"),
        (3, "ended with exit code 3"),
        (-11, "was killed by SIGSEGV"),
        (-200, "was killed by signal 200"),
        (0xC0000005, "ended by an access violation (0xC0000005)"),
    ],
)
def test_how_a_process_ended_in_words(returncode: int, words: str) -> None:
    assert described(returncode) == words


def test_an_interrupt_that_nobody_catches_is_an_orderly_end_only_when_it_was_asked_for() -> None:
    policy = two()
    replay(policy, [(1, "interrupt")])
    assert policy.exited("a", 1, 2, "KeyboardInterrupt") == []
    assert policy.exited("b", 1, 2, "KeyError: 1") == [Say("b ended with exit code 1: KeyError: 1")]
    [said, *_] = two().exited("a", 1, 2, "KeyboardInterrupt")
    assert said == Say("a ended with exit code 1: KeyboardInterrupt")


def test_a_python_that_is_interrupted_before_it_has_begun_ends_in_order() -> None:
    cause = "Fatal Python error: init_import_site: Failed to import the site module"
    policy = two()
    replay(policy, [(1, "interrupt")])
    assert policy.exited("a", 1, 2, cause) == []
    [said, *_] = two().exited("a", 1, 2, cause)
    assert said == Say(f"a ended with exit code 1: {cause}")


def test_windows_ends_a_process_with_code_1_when_it_is_told_to(monkeypatch: pytest.MonkeyPatch) -> None:
    assert not is_orderly(1, TERMINATE)
    monkeypatch.setattr("sys.platform", "win32")
    assert is_orderly(1, TERMINATE)
    assert not is_orderly(1, INTERRUPT)
    assert is_orderly(0xC000013A, INTERRUPT)
