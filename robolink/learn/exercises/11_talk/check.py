"""Check of two nodes in one file."""

from __future__ import annotations

from robolink.learn.trial import Trial


def check(trial: Trial) -> None:
    """Listen to the topic, and look for the listener's lines."""
    trial.start()
    trial.tell("talks", trial.heard("chatter", within=3.0))
    trial.tell(
        "runs", "/listener" in trial.system.nodes, nodes=", ".join(each.strip("/") for each in trial.system.nodes)
    )
    trial.run(2.5)
    trial.tell("hears", any("heard hello" in each.message for each in trial.system.logs))
