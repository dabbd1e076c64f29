"""The key `limits` of a launch file: what of a system leaves this machine, and how often."""

from __future__ import annotations

from pathlib import Path

import pytest

from robolink.exceptions import DocumentError
from robolink.launch.planning import network_of
from robolink.launch.reading.arguments import limits_of
from robolink.launch.reading.entries import read_launch_file, read_with_mistakes
from robolink.networks.limits import Limits

NODES = "nodes: [{run: [python]}]"
TEXT = f"limits:\n  control: [/cmd_vel]\n  rate: {{/camera/image: 2}}\n{NODES}"
WRITTEN = '{"control": ["/cmd_vel"], "rate": {"/camera/image": 2.0}}'


def test_all_processes_get_them_unless_the_environment_has_some() -> None:
    entries = read_launch_file("lab.yaml", text=TEXT)
    assert network_of(entries, {}) == {"ROBOLINK_LIMITS": WRITTEN}
    assert network_of(entries, {"ROBOLINK_LIMITS": "{}"}) == {}
    both = read_launch_file("lab.yaml", text=f"network: lan\n{TEXT}")
    assert network_of(both, {}) == {"ROBOLINK_NETWORK": "lan", "ROBOLINK_LIMITS": WRITTEN}
    assert network_of(read_launch_file("lab.yaml", text=NODES), {}) == {}


def test_an_argument_may_be_a_rate() -> None:
    text = f'arguments: {{rate: 4}}\nlimits: {{rate: {{/scan: "{{rate}}"}}}}\n{NODES}'
    (entry,) = read_launch_file("lab.yaml", {"rate": "3"}, text=text)
    assert entry.limits == '{"rate": {"/scan": 3.0}}'


@pytest.mark.parametrize(
    ("line", "reason"),
    [
        ("limits: {rate: {/a: 0}}", "lab.yaml:1:21: limits.rate./a: expected messages a second"),
        ("limits: {rat: {/a: 1}}", "lab.yaml:1:10: limits.rat: unknown key 'rat' (did you mean 'rate'?)"),
        ("limits: {control: [cmd_vel]}", "lab.yaml:1:20: limits.control[0]: 'cmd_vel' is not a full name of a topic"),
        ("limits: [/a]", "lab.yaml:1:9: limits: expected mapping"),
        ("limit: {}", "lab.yaml:1:1: limit: unknown key 'limit' (did you mean 'limits'?)"),
    ],
)
def test_a_mistake_has_its_place(line: str, reason: str) -> None:
    with pytest.raises(DocumentError) as caught:
        read_launch_file("lab.yaml", text=f"{line}\n{NODES}")
    assert str(caught.value).startswith(reason)
    assert "\n" not in str(caught.value)
    _, mistakes = read_with_mistakes("lab.yaml", text=f"{line}\n{NODES}")
    assert [str(each) for each in mistakes] == [str(caught.value)]


def test_included_files_say_the_same_or_nothing(tmp_path: Path) -> None:
    (tmp_path / "inner.yaml").write_text(TEXT)
    outer = tmp_path / "outer.yaml"
    outer.write_text(f"{TEXT}\ninclude: [{{file: inner.yaml, namespace: r1}}]\n")
    assert {each.limits for each in read_launch_file(outer)} == {WRITTEN}
    (tmp_path / "inner.yaml").write_text(f"limits: {{buffer: 8192}}\n{NODES}")
    with pytest.raises(DocumentError, match=r"inner\.yaml:1:1: limits: the files around it have other `limits`"):
        read_launch_file(outer)


def test_limits_of_a_file_alone(tmp_path: Path) -> None:
    path = tmp_path / "slow.yaml"
    path.write_text(TEXT)
    found = limits_of(path)
    assert found.limits == Limits(control=["/cmd_vel"], rate={"/camera/image": 2.0})
    assert str(found.error(("rate", "/camera/image"), "unknown")).endswith(
        "slow.yaml:3:25: limits.rate./camera/image: unknown"
    )
    path.write_text("rate: {/scan: 1}")
    found = limits_of(path)
    assert found.limits == Limits(rate={"/scan": 1.0})
    assert str(found.error(("rate", "/scan"), "unknown")).endswith("slow.yaml:1:15: rate./scan: unknown")
    path.write_text(NODES)
    with pytest.raises(DocumentError, match=r"slow\.yaml.*: no key 'limits': nothing is limited"):
        limits_of(path)
