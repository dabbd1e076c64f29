"""What a launcher decides: tables of histories, and that no history at all breaks its rules."""

from __future__ import annotations

import pytest
from hypothesis import strategies as st

from robolink.supervisor.policy import Ask, Policy, Restarts, Rules, Say, Start, Step, described
from tests.support.policies import PLAIN, replay, two

INTERRUPT, TERMINATE, KILL = Step.INTERRUPT, Step.TERMINATE, Step.KILL
IGNORED = Rules(on_exit="ignore")
HELD = Rules(held=True)
RESPAWNED = Rules(Restarts("on_failure", delay=2.0, most=2, within=60.0))
FOR_EVER = Rules(Restarts("always", delay=1.0, delay_max=4.0, most=99))


def asked(*names: str, step: Step) -> list[Ask]:
    return [Ask(name, step) for name in names]


# --- the end --------------------------------------------------------------------------------------------------

CODES: list[tuple[str, list[tuple[float, object]], int]] = [
    ("the first to end decides", [(1, ("a", 3)), (2, ("b", 1))], 3),
    ("a clean end is one too", [(1, ("a", 0)), (2, ("b", 1))], 0),
    ("a signal counts from 128", [(1, ("a", -11)), (2, ("b", 0))], 139),
    ("an orderly stop", [(1, "interrupt"), (2, ("a", 0)), (3, ("b", -2))], 0),
    ("a stop with 130 and 143", [(1, "interrupt"), (2, ("a", 130)), (3, ("b", 143))], 0),
    ("a crash while stopping", [(1, "interrupt"), (2, ("a", 0)), (3, ("b", 1))], 1),
    ("the first crash while stopping", [(1, "end"), (2, ("a", 7)), (3, ("b", 1))], 7),
    ("one that had to be killed", [(1, "interrupt"), (6, None), (11, None), (12, ("a", -9)), (12, ("b", 0))], 137),
    ("the duration is over", [(60, None), (61, ("a", 0)), (61, ("b", -2))], 0),
    ("each stopped on request", [(1, ("a", "stop")), (2, ("a", 0)), (3, ("b", "stop")), (4, ("b", -2))], 0),
    ("the last stopped in disorder", [(1, ("a", "stop")), (2, ("a", 1)), (3, ("b", "stop")), (4, ("b", 5))], 5),
    ("an end after one was stopped", [(1, ("a", "stop")), (2, ("a", 1)), (4, ("b", 6))], 6),
]


@pytest.mark.parametrize(("history", "code"), [each[1:] for each in CODES], ids=[each[0] for each in CODES])
def test_the_exit_code(history: list[tuple[float, object]], code: int) -> None:
    policy = two(ends=60)
    replay(policy, history)
    assert policy.is_over
    assert policy.code == code


@pytest.mark.parametrize(
    ("first", "second", "code"),
    [(("a", 3), ("b", 0), 0), (("a", 0), ("b", 3), 3), (("b", -11), ("a", 2), 2)],
)
def test_when_every_end_is_ignored_the_last_is_the_end(
    first: tuple[str, int], second: tuple[str, int], code: int
) -> None:
    policy = two(IGNORED, IGNORED)
    [actions] = replay(policy, [(1, first)])
    assert actions == [Say(f"{first[0]} {described(first[1])}")]
    replay(policy, [(2, second)])
    assert policy.is_over
    assert policy.code == code


def test_an_ignored_end_stops_nobody_and_another_still_does() -> None:
    policy = two(IGNORED, PLAIN)
    ignored, ends = replay(policy, [(1, ("a", 3)), (2, ("b", 4))])
    assert ignored == [Say("a ended with exit code 3")]
    assert ends == [Say("b ended with exit code 4")]
    assert policy.is_over
    assert policy.code == 4


def test_the_cause_is_told() -> None:
    policy = two()
    [said, *_] = policy.exited("a", 1, 1.0, "ZeroDivisionError: division by zero")
    assert said == Say("a ended with exit code 1: ZeroDivisionError: division by zero")
    [said] = two(RESPAWNED).exited("a", 1, 1.0, "KeyError: 1")
    assert said == Say("a ended with exit code 1: KeyError: 1; starting it again in 2 s (1 of 2 within 60 s)")


def test_each_step_comes_when_patience_ends() -> None:
    policy = two()
    told = replay(policy, [(1, ("a", 3)), (5.9, None), (6, None), (11, None), (15, None), (16, None)])
    assert told == [
        [Say("a ended with exit code 3"), *asked("b", step=INTERRUPT)],
        [],
        [Say("still running after 5 s: b"), *asked("b", step=TERMINATE)],
        [Say("still running after 5 s: b"), *asked("b", step=KILL)],
        [],
        [Say("still running after 5 s: b")],
    ]
    assert policy.is_over


def test_a_second_interrupt_goes_straight_to_the_next_step() -> None:
    policy = two()
    first, echo, second, end, third = replay(
        policy, [(1, "interrupt"), (1.1, "interrupt"), (2, "interrupt"), (3, "end"), (4, "interrupt")]
    )
    assert first == [Say("stopping (Ctrl-C again to hurry)"), *asked("a", "b", step=INTERRUPT)]
    assert second == asked("a", "b", step=TERMINATE)
    assert third == asked("a", "b", step=KILL)
    assert echo == end == []


def test_one_that_cannot_be_killed_is_given_up() -> None:
    policy = two()
    replay(policy, [(0, ("b", "stop")), (0, ("b", 0)), (0, "end"), (5, None), (10, None), (15, None)])
    assert policy.is_over
    assert policy.code == 137


# --- starting again -------------------------------------------------------------------------------------------


def test_a_process_that_fails_is_started_again_until_it_is_given_up() -> None:
    policy = two(RESPAWNED)
    history: list[tuple[float, object]] = [
        (1, ("a", 1)),
        (2.9, None),
        (3, None),
        (4, ("a", -11)),
        (8, None),
        (9, ("a", 3)),
    ]
    assert replay(policy, history) == [
        [Say("a ended with exit code 1: starting it again in 2 s (1 of 2 within 60 s)")],
        [],
        [Start("a")],
        [Say("a was killed by SIGSEGV: starting it again in 4 s (2 of 2 within 60 s)")],
        [Start("a")],
        [Say("a ended with exit code 3: given up after 2 new starts within 60 s"), *asked("b", step=INTERRUPT)],
    ]
    assert policy.code == 3
    assert policy.processes["a"].restarts == 2


def test_a_clean_end_is_none_to_start_again_after_unless_always() -> None:
    assert replay(two(RESPAWNED), [(1, ("a", 0))]) == [[Say("a has ended"), *asked("b", step=INTERRUPT)]]
    [[said]] = replay(two(FOR_EVER), [(1, ("a", 0))])
    assert said == Say("a has ended: starting it again in 1 s (1 of 99 within 60 s)")


def test_starts_that_are_long_ago_do_not_count() -> None:
    policy, now = two(RESPAWNED), 0.0
    for _ in range(20):
        now += 100.0
        [said] = policy.exited("a", 1, now)
        assert said == Say("a ended with exit code 1: starting it again in 2 s (1 of 2 within 60 s)")
        now += 2.0
        assert policy.woken(now) == [Start("a")]


def test_the_delay_grows_to_its_greatest_and_falls_back_after_a_good_run() -> None:
    policy, now, delays = two(FOR_EVER), 0.0, []
    for ran in (1, 1, 1, 1, 60, 1):
        now += ran
        policy.exited("a", 1, now)
        assert policy.deadline is not None
        delays.append(policy.deadline - now)
        now = policy.deadline
        assert policy.woken(now) == [Start("a")]
    assert delays == [1, 2, 4, 4, 1, 2]


def test_a_delay_beyond_the_greatest_is_kept() -> None:
    assert [Restarts(delay=60.0, delay_max=30.0).pause(streak) for streak in (0, 1, 5000)] == [60.0, 60.0, 60.0]


def test_given_up_is_an_end_like_others_to_be_ignored_or_not() -> None:
    policy = two(Rules(RESPAWNED.respawn, on_exit="ignore"))
    replay(policy, [(1, ("a", 1)), (3, None), (4, ("a", 1)), (8, None)])
    assert replay(policy, [(9, ("a", 1))]) == [
        [Say("a ended with exit code 1: given up after 2 new starts within 60 s")]
    ]
    assert not policy.is_over


def test_a_process_that_waits_for_its_start_keeps_the_system_and_a_stop_cancels_it() -> None:
    policy = two(RESPAWNED, IGNORED)
    replay(policy, [(1, ("a", 1)), (1, ("b", 0))])
    assert policy.deadline == 3
    replay(policy, [(2, "interrupt")])
    assert policy.is_over
    assert replay(policy, [(3, None)]) == [[]]


# --- held, restarted, stopped ---------------------------------------------------------------------------------


def test_a_held_process_starts_once_when_it_is_released() -> None:
    policy = Policy({"a": PLAIN, "b": HELD})
    assert policy.begin(0) == [Start("a")]
    assert replay(policy, [(1, ("b", "release")), (2, ("b", "release"))]) == [[Start("b")], []]


def test_a_held_process_is_never_started_once_the_system_stops() -> None:
    policy = Policy({"a": PLAIN, "b": HELD})
    policy.begin(0)
    assert replay(policy, [(1, ("a", 0)), (2, ("b", "release"))]) == [[Say("a has ended")], []]
    assert policy.is_over


def test_what_waits_when_nothing_runs_any_more_is_told() -> None:
    policy = Policy({"a": IGNORED, "b": HELD})
    policy.begin(0)
    assert policy.exited("a", 0, 1) == [Say("a has ended"), Say("nothing runs any more; not started yet: b")]
    assert not policy.is_over


AWAITS_A = Rules(held=True, awaits=frozenset("a"))
AWAITS_B = Rules(held=True, awaits=frozenset("b"))


def test_who_waits_for_what_has_ended_waits_for_ever_and_that_is_the_end() -> None:
    policy = Policy({"a": IGNORED, "b": AWAITS_A, "c": AWAITS_B})
    policy.begin(0)
    vain = "b waits for a, which has ended; c waits for a, which has ended"
    assert policy.exited("a", 0, 1) == [Say("a has ended"), Say(f"nothing runs any more, and {vain}")]
    assert policy.is_over
    assert policy.code == 1


@pytest.mark.parametrize(
    ("rules", "history"),
    [
        ({"a": IGNORED, "b": AWAITS_A, "c": HELD}, [("a", 0)]),
        ({"a": IGNORED, "b": AWAITS_A, "c": IGNORED}, [("a", 0)]),
        ({"a": Rules(RESPAWNED.respawn, "ignore"), "b": AWAITS_A}, [("a", 1)]),
        ({"a": IGNORED, "b": AWAITS_A}, [("a", "stop"), ("a", 0)]),
    ],
    ids=["another waits for anything", "another runs", "it is started again", "it was stopped: it may be restarted"],
)
def test_as_long_as_something_may_come_the_system_goes_on(rules: dict[str, Rules], history: list[object]) -> None:
    policy = Policy(rules)
    policy.begin(0)
    replay(policy, [(1, event) for event in history])
    assert not policy.is_over


def test_the_last_that_runs_may_be_stopped_by_somebody() -> None:
    policy = Policy({"a": IGNORED, "b": AWAITS_A, "c": PLAIN})
    policy.begin(0)
    replay(policy, [(1, ("a", 0)), (2, ("c", "stop")), (3, ("c", 0))])
    assert policy.is_over
    assert policy.code == 1


def test_a_restart_on_request_is_orderly_and_no_failure() -> None:
    policy = two(RESPAWNED)
    asking, again, ended = replay(policy, [(1, ("a", "restart")), (1.5, ("a", "restart")), (2, ("a", -2))])
    assert asking == [Say("restarting a"), Ask("a", INTERRUPT)]
    assert again == []
    assert ended == [Start("a")]
    assert policy.exited("a", 1, 3) == [Say("a ended with exit code 1: starting it again in 2 s (1 of 2 within 60 s)")]


def test_a_restart_escalates_like_a_stop() -> None:
    policy = two()
    told = replay(policy, [(1, ("a", "restart")), (6, None), (11, None), (16, None), (17, ("a", -9))])
    assert told == [
        [Say("restarting a"), Ask("a", INTERRUPT)],
        [Say("still running after 5 s: a"), Ask("a", TERMINATE)],
        [Say("still running after 5 s: a"), Ask("a", KILL)],
        [Say("a cannot be killed")],
        [Say(f"a {described(-9)}"), Start("a")],
    ]


@pytest.mark.parametrize(
    "before",
    [[("b", 0)], [("b", "stop"), ("b", 0)], [("b", 1)]],
    ids=["ended", "stopped", "waiting"],
)
def test_a_process_that_does_not_run_is_started_by_a_restart(before: list[object]) -> None:
    policy = two(PLAIN, Rules(RESPAWNED.respawn, on_exit="ignore"))
    replay(policy, [(1, event) for event in before])
    assert replay(policy, [(1, ("b", "restart"))]) == [[Say("starting b"), Start("b")]]
    assert policy.woken(50) == []


def test_nothing_is_restarted_on_the_way_to_the_end() -> None:
    policy = two(PLAIN, PLAIN)
    assert policy.why_not_restarted("b") == ""
    policy.interrupted(1)
    assert policy.why_not_restarted("b") == "the system is stopping"
    assert policy.restart("b", 1) == [Say("b is not restarted: the system is stopping")]


def test_a_restart_starts_nothing_that_waits_for_something_else() -> None:
    policy = two(PLAIN, HELD)
    why_not = policy.why_not_restarted("b")
    assert why_not == "it is not started yet, since it waits for something else"
    assert policy.restart("b", 1) == [Say(f"b is not restarted: {why_not}")]
    assert policy.processes["b"].state == "held"
    policy.stop_one("b", 2)
    assert policy.restart("b", 3) == [Say("starting b"), Start("b")]


def test_a_restart_gives_a_process_all_its_starts_back() -> None:
    policy = two(Rules(RESPAWNED.respawn, on_exit="ignore"))
    replay(policy, [(1, ("a", 1)), (3, None), (4, ("a", 1)), (8, None), (9, ("a", 1)), (10, ("a", "restart"))])
    assert policy.exited("a", 1, 11) == [Say("a ended with exit code 1: starting it again in 2 s (1 of 2 within 60 s)")]


def test_one_process_may_have_a_patience_of_its_own() -> None:
    policy = two(Rules(on_exit="ignore", patience=(1.0, 3.0)))
    assert policy.stop_one("a", 10) == [Say("stopping a"), Ask("a", INTERRUPT)]
    assert policy.deadline == 11.0
    assert policy.woken(11) == [Say("still running after 1 s: a", "WARN"), Ask("a", TERMINATE)]
    assert policy.deadline == 14.0
    assert policy.woken(14) == [Say("still running after 3 s: a", "WARN"), Ask("a", KILL)]


def test_the_end_of_the_system_waits_as_long_as_its_processes_want() -> None:
    policy = two(Rules(patience=(1.0, 3.0)), Rules(patience=(2.0, 0.5)))
    policy.interrupted(10)
    assert policy.deadline == 12.0
    assert policy.woken(12)[0] == Say("still running after 2 s: a, b", "WARN")
    assert policy.deadline == 15.0
    policy.exited("a", -15, 13)
    assert policy.deadline == 12.5
    assert policy.woken(13) == [Say("still running after 0.5 s: b", "WARN"), Ask("b", KILL)]


def test_a_process_that_was_interrupted_already_gets_the_next_step_in_time() -> None:
    policy = two(PLAIN)
    assert policy.stop_one("a", 1, is_interrupted=True) == [Say("stopping a")]
    assert policy.woken(6) == [Say("still running after 5 s: a", "WARN"), Ask("a", TERMINATE)]


def test_one_process_stops_and_the_others_go_on() -> None:
    policy = two(FOR_EVER, PLAIN)
    told = replay(policy, [(1, ("a", "stop")), (2, ("a", 0)), (3, ("a", "stop"))])
    assert told == [[Say("stopping a"), Ask("a", INTERRUPT)], [Say("a has stopped")], []]
    assert not policy.is_over
    assert policy.processes["a"].state == "stopped"


def test_a_stop_turns_a_restart_that_is_on_its_way_into_a_stop_and_the_other_way_round() -> None:
    for last, state in [("stop", "stopped"), ("restart", "running")]:
        policy = two()
        replay(policy, [(1, ("a", "restart")), (1, ("a", "stop")), (1, ("a", last)), (2, ("a", 0))])
        assert policy.processes["a"].state == state


def test_who_waits_is_not_started_after_a_stop() -> None:
    policy = two(RESPAWNED, HELD)
    replay(policy, [(1, ("a", 1)), (2, ("a", "stop")), (2, ("b", "stop"))])
    assert policy.is_over
    assert policy.code == 0


def test_the_end_of_the_system_does_not_disturb_one_that_is_stopping_already() -> None:
    policy = two()
    replay(policy, [(1, ("a", "restart"))])
    stop, harder = replay(policy, [(2, "interrupt"), (7, None)])
    assert stop == [Say("stopping (Ctrl-C again to hurry)"), Ask("b", INTERRUPT)]
    assert harder == [Say("still running after 5 s: a, b"), *asked("a", "b", step=TERMINATE)]
    assert replay(policy, [(8, ("a", -15)), (8, ("b", -15)), (9, ("a", "restart"))])[:2] == [[], []]
    assert policy.is_over
    assert policy.code == 0


names = st.sampled_from("abc")
