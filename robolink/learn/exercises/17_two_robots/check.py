"""Check of a launch file for two robots."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from robolink.documents.yamlfile import parse
from robolink.learn.trial import Trial


def check(trial: Trial) -> None:
    """Launch it beside the world, and look at both robots."""
    trial.world("hall.yaml")
    trial.system.launch(trial.file)
    trial.run(10.0)
    trial.tell("one_world", "world" not in nodes_of(trial.file))
    ada, bob = trial.system.robot("ada"), trial.system.robot("bob")
    for robot in (ada, bob):
        nodes = [each.strip("/") for each in trial.system.nodes if each != "/world"]
        has_node = f"{robot.name}/reactive_controller" in nodes
        trial.tell(robot.name, has_node and robot.driven > 1.0, nodes=", ".join(nodes) or "-")
    contacts = ada.contacts + bob.contacts
    trial.tell("free", contacts == 0, contacts=contacts)


def nodes_of(file: Path) -> list[object]:
    """Return the nodes of a launch file that has just been launched."""
    system: Any = parse(file.read_text(encoding="utf-8"), name=file.name)
    return [each.get("node") for each in system.get("nodes", [])]
