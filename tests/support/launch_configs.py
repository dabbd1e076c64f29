"""Launch files of a fleet, for tests of what they come to."""

from __future__ import annotations

from pathlib import Path

from robolink.launch import Entry, read_launch_file

CONFIGS = {
    "robot": """
arguments:
  id:
  mode: {default: slow, choices: [slow, fast]}
nodes:
- {node: mine, name: "driver_{id}", parameters: {id: "{id}", mode: "{mode}"}, start_after: world}
""",
    "gains": """
/**:
  ros__parameters: {gain: 1, careful: yes}
/r0/mine:
  ros__parameters: {gain: 2.5}
""",
}


def entries(home: Path, text: str, **given: str) -> dict[str, Entry]:
    found = read_launch_file(home / "configs" / "lap.yaml", given, text=text)
    return {each.name: each for each in found}
