"""robolink learn view, as a process: the page of a student's folder, a file that is saved, and its end."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from websockets.sync.client import connect

from robolink.learn.folder import start_folder
from tests.support.commands import Command
from tests.support.view_clients import Client

SOLUTIONS = Path(__file__).parents[2] / "learn" / "solutions"


@pytest.mark.processes
def test_a_file_that_is_saved_is_checked_and_ctrl_c_ends_it(domain: int, tmp_path: Path) -> None:
    start_folder(str(tmp_path), language="pt").write()
    with Command(domain, "learn", "view", "--port", "0", "--no-browser", folder=tmp_path) as command:
        address = re.search(r"http://(\S+)/\?(token=\S+)#learn", command.wait_for("robolink view: http").text)
        assert address is not None
        with connect(f"ws://{address[1]}/?{address[2]}", subprotocols=["robolink.v1"]) as wire:  # type: ignore[list-item]
            client = Client(wire)
            assert client.wait_for("learn", checking=None)["language"] == "pt"
            client.send("learn", command="show", name="walk")
            assert not client.wait_for("exercise", name="walk")["report"]["passed"]
            (tmp_path / "01_walk.py").write_bytes((SOLUTIONS / "01_walk.py").read_bytes())
            while not client.wait_for("exercise", name="walk")["report"]["passed"]:  # that of before, told twice
                pass
            command.wait_for("01_walk.py está feito")
        command.interrupt()
        assert command.end() in {0, 130}
        assert not any("Traceback" in each.text for each in command.errors)
