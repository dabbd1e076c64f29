"""The launcher's state machine under any history of events: no history breaks its rules."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from robolink.supervisor.policy import Action, Ask, Policy, Restarts, Rules, Start
from tests.support.policies import tell

names = st.sampled_from("abc")

events = (
    st.sampled_from(["interrupt", "end", None, None, None])
    | st.tuples(names, st.integers(-15, 255))
    | st.tuples(names, st.sampled_from(["restart", "stop", "release"]))
)

restarts = st.builds(
    Restarts,
    st.sampled_from(["never", "on_failure", "always"]),
    st.sampled_from([0.0, 1.0, 1e300]),
    st.sampled_from([0.0, 30.0]),
    st.integers(1, 3),
    st.sampled_from([0.0, 60.0]),
)

rules_of_three = st.fixed_dictionaries(
    {name: st.builds(Rules, restarts, st.sampled_from(["shutdown", "ignore"]), st.booleans()) for name in "abc"}
)


class Machine:
    """Does what a policy wants done, and checks that it may be wanted."""

    def __init__(self, rules: dict[str, Rules]) -> None:
        self.policy = Policy(rules, ends=500.0)
        self.alive: set[str] = set()

    def do(self, actions: list[Action]) -> None:
        for action in actions:
            if isinstance(action, Start):
                assert action.name not in self.alive
                assert self.policy.step is None
                self.alive.add(action.name)
            elif isinstance(action, Ask):
                assert action.name in self.alive

    def tell(self, now: float, event: object) -> None:
        if isinstance(event, tuple) and isinstance(event[1], int):
            self.alive.discard(event[0])
        self.do(tell(self.policy, now, event))
        assert set(self.policy.alive) == self.alive


@given(rules_of_three, st.lists(st.tuples(st.floats(0, 9), events), max_size=40))
def test_any_history_ends_and_starts_or_asks_only_who_may_be(
    rules: dict[str, Rules], history: list[tuple[float, object]]
) -> None:
    machine, now = Machine(rules), 0.0
    machine.do(machine.policy.begin(now))
    for wait, event in [*history, *[(500.0, None)] * 5]:
        now += wait
        machine.tell(now, event)
    assert machine.policy.is_over
    assert machine.policy.deadline is None
    assert 0 <= machine.policy.code <= 255


@given(rules_of_three, st.lists(st.tuples(st.floats(0, 9), events), max_size=40))
def test_whoever_wakes_at_each_deadline_is_never_woken_in_vain(
    rules: dict[str, Rules], history: list[tuple[float, object]]
) -> None:
    """A loop that waits for the deadline, and then again, must not turn for ever without a step."""
    machine, now = Machine(rules), 0.0
    machine.do(machine.policy.begin(now))
    for wait, event in history:
        now += wait
        machine.tell(now, event)
        deadline = machine.policy.deadline
        if deadline is not None and not machine.policy.is_over:
            now = max(now, deadline)
            machine.tell(now, None)
            after = machine.policy.deadline
            assert machine.policy.is_over or after is None or after > now or machine.policy.step is not None
