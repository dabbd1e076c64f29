"""Check of a first node: its name, its line of the log, and that it stays."""

from __future__ import annotations

from robolink.learn.trial import Trial


def check(trial: Trial) -> None:
    """Look for the node, and for its line."""
    trial.start()
    nodes = trial.system.nodes
    trial.tell("starts", nodes)
    trial.tell("named", "/first_node" in nodes, name=nodes[0].strip("/"))
    trial.run(5.0)
    trial.tell("says", any("hello" in each.message.lower() for each in trial.system.logs))
    trial.tell("answers", trial.answers())
    trial.run(1.0)
    trial.tell("stays", trial.system.nodes)
