"""action list, type, find and info: ros2's output."""

from __future__ import annotations

import json
from typing import Any

import pytest

from robolink.cli.main import main
from tests.support.busy_actions import POLISH, TYPE

Captured = pytest.CaptureFixture[str]


@pytest.mark.parametrize(
    ("words", "shown"),
    [
        (["list"], ["/elsewhere", "/lab/sums", "/polish"]),
        (["list", "-c"], ["3"]),
        (["list", "-t"], [f"/elsewhere [{TYPE}]", f"/lab/sums [{TYPE}]", f"/polish [{POLISH}]"]),
        (["type", "/lab/sums"], [TYPE]),
        (["type", "lab/sums"], [TYPE]),
        (["find", TYPE], ["/elsewhere", "/lab/sums"]),
        (["find", "Fibonacci", "--count-actions"], ["2"]),
        (["find", "Nothing"], []),
        (
            ["info", "/lab/sums"],
            ["Action: /lab/sums", "Action clients: 1", "    /panel", "Action servers: 1", "    /lab/robot"],
        ),
        (["info", "lab/sums", "-c"], ["Action: /lab/sums", "Action clients: 1", "Action servers: 1"]),
        (
            ["info", "/polish", "-t"],
            [
                "Action: /polish",
                "Action clients: 0",
                "Action servers: 1",
                f"    /lab/robot [{POLISH}]",
            ],
        ),
    ],
)
@pytest.mark.usefixtures("busy")
def test_actions_are_shown_as_ros2_shows_them(words: list[str], shown: list[str], capsys: Captured) -> None:
    assert main(["action", *words]) == 0
    assert capsys.readouterr() == ("".join(f"{each}\n" for each in shown), "")


@pytest.mark.parametrize(
    ("words", "value"),
    [
        (["list"], {"/elsewhere": [TYPE], "/lab/sums": [TYPE], "/polish": [POLISH]}),
        (["type", "/lab/sums"], [TYPE]),
        (["find", "Polish"], ["/polish"]),
        (
            ["info", "/lab/sums"],
            {"name": "/lab/sums", "action_clients": {"/panel": [TYPE]}, "action_servers": {"/lab/robot": [TYPE]}},
        ),
    ],
)
@pytest.mark.usefixtures("busy")
def test_programs_read_json(words: list[str], value: Any, capsys: Captured) -> None:
    assert main(["action", *words, "--json"]) == 0
    assert json.loads(capsys.readouterr().out) == value


@pytest.mark.parametrize("verb", ["type", "info"])
@pytest.mark.usefixtures("busy")
def test_an_action_that_is_not_there(verb: str, capsys: Captured) -> None:
    assert main(["action", verb, "/lab/sum"]) == 1
    assert capsys.readouterr() == (
        "",
        "robolink: no action named '/lab/sum' in domain 7 (did you mean '/lab/sums'?)\n",
    )


@pytest.mark.usefixtures("busy")
def test_node_info_lists_actions_and_hides_what_they_are_made_of(capsys: Captured) -> None:
    assert main(["node", "info", "/lab/robot"]) == 0
    out = capsys.readouterr().out
    servers = f"  Action Servers:\n    /lab/sums: {TYPE}\n    /polish: {POLISH}\n"
    assert out.endswith(f"{servers}  Action Clients:\n    /elsewhere: {TYPE}\n")
    assert "/_action/" not in out
