"""Check of two nodes in one file."""

from __future__ import annotations

from robolink.learn.trial import Trial


def check(trial: Trial) -> None:
    """Listen to the topic, and look for the listener's lines."""
    said = trial.system.messages("chatter")
    trial.start()
    trial.tell("talks", trial.heard("chatter", within=3.0))
    nodes = ", ".join(each.strip("/") for each in trial.system.nodes)
    trial.tell("runs", "/listener" in trial.system.nodes, nodes=nodes)
    count = len(said)
    trial.run(3.0)
    count = len(said) - count
    trial.tell("pace", 2 <= count <= 4, count=count)
    words = [each.data for each in said[:3]]
    trial.tell("words", words == ["hello 1", "hello 2", "hello 3"], words=", ".join(words))
    lines = [each.message for each in trial.system.logs if each.name == "listener"]
    trial.tell("hears", lines)
    trial.tell("says", "heard hello 2" in lines, line=lines[-1])
