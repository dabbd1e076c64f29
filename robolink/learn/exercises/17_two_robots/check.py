"""Check of a launch file for two robots."""

from __future__ import annotations

from robolink.learn.trial import Trial


def check(trial: Trial) -> None:
    """Launch it beside the world, and look at both robots."""
    trial.world("hall.yaml")
    trial.system.launch(trial.file)
    trial.run(10.0)
    ada, bob = trial.system.robot("ada"), trial.system.robot("bob")
    trial.tell("ada", ada.driven > 1.0)
    trial.tell("bob", bob.driven > 1.0)
    contacts = ada.contacts + bob.contacts
    trial.tell("free", contacts == 0, contacts=contacts)
