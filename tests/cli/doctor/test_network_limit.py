"""robolink network limit: what is in force, and what of it fits no topic."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from robolink.cli.doctor import network as command
from robolink.cli.doctor.network import InForce
from robolink.cli.main import main
from robolink.launch.reading.arguments import limits_of
from robolink.networks.limits import Limits

SOME = Limits(control=["/cmd_vel"], rate={"/camera/image": 0.5}, size={"/map": 8000}, buffer=8192)


def test_what_is_in_force() -> None:
    assert command.limit_lines(InForce("ROBOLINK_LIMITS", SOME), ["wlan0"]) == [
        "limits    ROBOLINK_LIMITS",
        "at        wlan0",
        "first     /cmd_vel, /clock",
        "rate      /camera/image: 0.5 a second",
        "size      /map: 8,000 bytes",
        "buffer    8,192 bytes",
    ]
    assert command.limit_lines(InForce("a", Limits()), None) == [
        "limits    a",
        "at        all interfaces",
        "first     /clock",
    ]
    (line,) = command.limit_lines(InForce("", None), None)
    assert line.startswith("limits    none; docs/reference/networks.md")


def test_names_that_fit_nothing() -> None:
    names = ["/cmd_vel", "/camra/image", "/map"]
    assert command.unknown(InForce("ROBOLINK_LIMITS", SOME), names) == [
        "ROBOLINK_LIMITS: rate: no topic or service '/camera/image' is there now (did you mean '/camra/image'?)"
    ]
    assert command.unknown(InForce("ROBOLINK_LIMITS", SOME), []) == []  # nobody is there who could have it
    assert command.unknown(InForce("", None), names) == []


def test_interfaces_that_are_not_here() -> None:
    asked = InForce("ROBOLINK_LIMITS", Limits(interfaces=["eth0", "wlan1"]))
    assert command.absent(asked, ["eth0", "wlan0"]) == [
        "ROBOLINK_LIMITS: interfaces: no interface 'wlan1' is here now (did you mean 'wlan0'?), but eth0, wlan0"
    ]
    assert command.absent(asked, None) == command.absent(InForce("", None), ["eth0"]) == []


def test_names_of_a_file_have_its_place(tmp_path: Path) -> None:
    path = tmp_path / "lab.yaml"
    path.write_text("limits:\n  control: [/cmd_vle]\nnodes: [{run: [python]}]\n")
    found = limits_of(path)
    (line,) = command.unknown(InForce(str(path), found.limits, found), ["/cmd_vel"])
    assert line == (
        f"{path}:2:13: limits.control[0]: no topic or service '/cmd_vle' is there now (did you mean '/cmd_vel'?)"
    )


def test_the_settings_of_zenoh(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("ROS_DOMAIN_ID", "7")
    path = tmp_path / "slow.yaml"
    path.write_text("rate: {/scan: 5}\nbuffer: 8192\ninterfaces: [wlan0]\n")
    assert main(["network", "limit", str(path), "--zenoh"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["transport"] == {"link": {"tcp": {"so_sndbuf": 8192}}}
    assert found["downsampling"][0]["rules"][0] == {"key_expr": "7/scan/*/*", "freq": 5.0}


def test_a_mistake_is_one_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "slow.yaml"
    path.write_text("rate: {/scan: .nan}\n")
    assert main(["network", "limit", str(path)]) == 1
    assert capsys.readouterr().err == (
        f"robolink: {path}:1:15: rate./scan: expected messages a second, 0.001 to 1,000,000, got nan\n"
    )
