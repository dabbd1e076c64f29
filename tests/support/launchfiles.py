"""A workspace for tests of launch files: nodes of every kind, and files to include."""

from __future__ import annotations

from pathlib import Path

import pytest

from robolink.workspace import VARIABLE

NODES = {
    "mine": "from robolink import Node\nclass Mine(Node): pass\n",
    "script": "import rclpy\nrclpy.init()\n",
    "program": "class Other: pass\nclass One(Node): pass\nclass Two(Node): pass\ndef start(): pass\ndef main(): pass\n",
    "broken": "class",
}


def make_workspace(folder: Path, monkeypatch: pytest.MonkeyPatch, **configs: str) -> Path:
    """Make a workspace of `NODES` and these `configs`, and go there; give its path."""
    for part in ("nodes", "configs"):
        (folder / part).mkdir()
    for name, text in NODES.items():
        (folder / "nodes" / f"{name}.py").write_text(text)
    for name, text in configs.items():
        (folder / "configs" / f"{name}.yaml").write_text(text)
    monkeypatch.delenv(VARIABLE, raising=False)
    monkeypatch.chdir(folder)
    return folder.resolve()
