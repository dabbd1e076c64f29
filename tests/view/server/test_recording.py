"""The record button: a bag of all topics, whose state pages are told."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from robolink.bag.reader import open_bag
from robolink.interfaces.std_msgs.msg import String
from tests.support.view_clients import shown


def test_a_recording_is_begun_and_ended_by_the_page(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    with shown() as system, system.client() as client:
        assert client.wait_for("recording")["state"] == "off"
        publisher = system.node.create_publisher(String, "chat", 10)
        client.send("record", command="start", path="lap")
        told = client.wait_for("recording", state="on")
        assert Path(told["path"]) == tmp_path / "lap"
        while not told["messages"]:
            publisher.publish(String(data="x"))
            told = client.wait_for("recording", state="on")
        client.send("record", command="start")
        assert "already" in client.wait_for("status", level=2)["message"]
        client.send("record", command="stop")
        end: dict[str, Any] = client.wait_for("recording", state="off")
        with open_bag(tmp_path / "lap") as bag:
            assert bag.counts["/chat"] == end["messages"] >= told["messages"]
        client.send("record", command="stop")
        assert "nothing is being recorded" in client.wait_for("status", level=2)["message"]


@pytest.mark.parametrize("name", ["../lap", "/tmp/lap", "C:\\lap", "a/../../lap", "..\\lap", "/"])
def test_a_bag_is_not_written_anywhere_else(name: str) -> None:
    with shown() as system, system.client() as client:
        client.send("record", command="start", path=name)
        assert "not a name for a bag" in client.wait_for("status", level=2)["message"]


def test_a_recording_needs_the_token() -> None:
    with shown() as system, system.client(token=False) as client:
        client.send("record", command="start", path="x")
        assert "read-only" in client.wait_for("status", level=2)["message"]


def test_a_server_that_ends_leaves_a_whole_bag(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    with shown() as system, system.client() as client:
        client.send("record", command="start", path="cut")
        client.wait_for("recording", state="on")
        system.view.close()
        with open_bag(tmp_path / "cut") as bag:
            assert bag.is_whole
