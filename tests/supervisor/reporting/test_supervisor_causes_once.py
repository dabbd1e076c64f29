"""Why a process ended is said once as long as new starts help nothing, and anew when it is another reason."""

from __future__ import annotations

from robolink.supervisor.policy import Policy, Restarts, Rules, Say

AGAIN = Rules(Restarts("on_failure", delay=1.0, delay_max=1.0, most=9, within=60.0), "ignore")


def told(*ends: tuple[float, int, str]) -> list[str]:
    """Give what is said of a process that ends so: when, with which code, why; it is started 1 s later."""
    policy = Policy({"a": AGAIN, "b": Rules()})
    policy.begin(0.0)
    lines = []
    for at, code, cause in ends:
        lines += [each.text for each in policy.exited("a", code, at, cause) if isinstance(each, Say)]
        policy.woken(at + 1.0)
    return [each.partition("starting")[0] for each in lines]


def test_the_same_reason_is_said_once() -> None:
    first, second = "a ended with exit code 1: no camera; ", "a ended with exit code 1 as before: "
    assert told((1, 1, "no camera"), (3, 1, "no camera"), (5, 1, "no camera")) == [first, second, second]


def test_another_reason_is_said() -> None:
    lines = told((1, 1, "no camera"), (3, 1, "no disk"), (5, 3, "no disk"), (7, 3, ""))
    assert lines == [
        "a ended with exit code 1: no camera; ",
        "a ended with exit code 1: no disk; ",
        "a ended with exit code 3: no disk; ",
        "a ended with exit code 3: ",
    ]


def test_after_a_long_life_the_reason_is_news() -> None:
    assert told((1, 1, "no camera"), (100, 1, "no camera"))[1] == "a ended with exit code 1: no camera; "


def test_after_somebody_has_restarted_it_the_reason_is_news() -> None:
    policy = Policy({"a": AGAIN, "b": Rules()})
    policy.begin(0.0)
    policy.exited("a", 1, 1.0, "no camera")
    policy.restart("a", 1.5)
    [said] = policy.exited("a", 1, 2.0, "no camera")
    assert isinstance(said, Say)
    assert said.text.startswith("a ended with exit code 1: no camera; ")
