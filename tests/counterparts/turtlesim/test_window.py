"""The window of turtlesim: a page on a free port, opened for a person at a screen, and no condition of the node."""

from __future__ import annotations

import re
import sys
import threading
import urllib.request

import pytest

from robolink import Context, Node
from robolink.counterparts.turtlesim import window as windows
from robolink.counterparts.turtlesim.window import window
from robolink.impl.log_output import Record
from robolink.view.server import ViewError

Captured = pytest.CaptureFixture[str]
ADDRESS = re.compile(r"http://127\.0\.0\.1:(\d+)/\?token=[\w-]+#turtlesim:/\w+/_picture\+services\n")


@pytest.fixture
def opened(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Addresses that the browser would have opened."""
    found: list[str] = []
    monkeypatch.setattr(windows, "open_in_browser", lambda address: not found.append(address))  # type: ignore[func-returns-value]
    return found


@pytest.fixture
def node(context: Context) -> Node:
    return Node("turtlesim", context=context)


def test_two_nodes_have_two_windows(node: Node, opened: list[str], capsys: Captured) -> None:
    with window(node, "/a/_picture"), window(Node("other", context=node.context), "/b/_picture"):
        told = capsys.readouterr().out
        ports = ADDRESS.findall(told)
        assert len(set(ports)) == 2
        for address in re.findall(r"http\S+(?=#)", told):
            with urllib.request.urlopen(address) as page:
                assert b"<!doctype html>" in page.read().lower()
        shown = {name for name, _ in node.get_node_names_and_namespaces() if not name.startswith("_")}
        assert shown == {"turtlesim", "other"}
    assert told.count("see the turtles in a browser: http") == 2
    assert opened == [], "nobody sits at a terminal"
    assert not [thread for thread in threading.enumerate() if thread.name == "robolink view"], "they have ended"


def test_a_person_at_a_terminal_gets_the_browser(
    node: Node, opened: list[str], capsys: Captured, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sys.stdout, "isatty", lambda: True)
    with window(node, "/a/_picture"):
        told = capsys.readouterr().out
    assert told == f"the turtles are in your browser: {opened[0]}\n"


def test_without_a_port_the_turtles_swim_unseen(
    node: Node, log_lines: list[Record], monkeypatch: pytest.MonkeyPatch, capsys: Captured
) -> None:
    def refuse(*_: object) -> str:
        raise ViewError("ports 8765 to 8784 are all in use: choose one by --port")

    monkeypatch.setattr(windows, "_served", refuse)
    with window(node, "/a/_picture"):
        pass
    assert log_lines[-1].message.startswith("no window: ports 8765 to 8784 are all in use")
    assert capsys.readouterr().out == ""


def test_in_virtual_time_there_is_none(virtual: Context, capsys: Captured) -> None:
    with window(Node("turtlesim", context=virtual), "/a/_picture"):
        assert capsys.readouterr().out == ""
