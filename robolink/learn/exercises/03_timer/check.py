"""Check of a timer: what the log has after one second and after ten."""

from __future__ import annotations

from robolink.learn.trial import Trial


def check(trial: Trial) -> None:
    """Compare the counts in the log."""
    trial.start()
    trial.run(1.5)
    trial.tell("begins", counts(trial) == ["count 1"], said=said(trial))
    trial.run(9.0)
    trial.tell("steady", counts(trial) == [f"count {number}" for number in range(1, 11)], said=said(trial))


def counts(trial: Trial) -> list[str]:
    """Return the lines of the log with a count."""
    return [each.message for each in trial.system.logs if "count" in each.message]


def said(trial: Trial) -> str:
    """Return the last counts for a sentence."""
    return ", ".join(counts(trial)[-4:]) or "-"
