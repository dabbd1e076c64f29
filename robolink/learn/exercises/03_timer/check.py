"""Check of a timer: what the log has after one second and after ten."""

from __future__ import annotations

from robolink.learn.trial import Trial


def check(trial: Trial) -> None:
    """Compare the counts in the log."""
    trial.start()
    trial.run(1.5)
    trial.tell("logs", trial.system.logs)
    trial.tell("begins", counts(trial) == ["count 1"], said=said(trial))
    trial.run(9.0)
    trial.tell("steady", counts(trial) == [f"count {number}" for number in range(1, 11)], said=said(trial))
    trial.tell("spins", trial.answers())


def counts(trial: Trial) -> list[str]:
    """Return the lines of the log, small letters and capitals alike."""
    return [each.message.lower() for each in trial.system.logs]


def said(trial: Trial) -> str:
    """Return the last counts for a sentence."""
    return ", ".join(counts(trial)[-4:])
