"""Faults files: what they may say, and what is told of one that says it wrongly."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.documents.yamlfile import spell
from robolink.exceptions import DocumentError
from robolink.faults import FaultsDescription, MessageFault, check_nodes, read_faults
from robolink.faults.description import matcher

EXAMPLES = sorted((Path(__file__).parents[2] / "configs" / "faults").glob("*.yaml"))

ALL = """
description: everything
seed: 3
messages:
  - {topic: /scan, loss: 0.05, burst: 5, duplication: 0.01, latency: 0.02, jitter: 0.01, reorder: true}
  - {from: world, to: [wall_follower, teleop], latency: 0.1, after: 10, until: 20}
  - {service: /world/reset, loss: 0.5}
partitions:
  - {between: [[world], [wall_follower, teleop]], after: 30, until: 35}
  - {between: [world, "**"]}
crashes:
  - {node: wall_follower, at: 40, restart_after: 2.0}
clocks:
  - {node: world, offset: -0.5, drift: 50e-6}
"""


def read(text: str) -> FaultsDescription:
    return read_faults("f.yaml", text=text).value


def test_all_that_a_file_may_say() -> None:
    faults = read(ALL)
    first, second, _ = faults.messages
    assert (first.topic, first.loss, first.burst, first.reorder) == ("/scan", 0.05, 5.0, True)
    assert (second.from_, second.to, second.after, second.until) == ("world", ["wall_follower", "teleop"], 10.0, 20.0)
    assert faults.partitions[1].between == ["world", "**"]
    assert (faults.crashes[0].restart_after, faults.clocks[0].drift, faults.seed) == (2.0, 50e-6, 3)


def test_an_empty_mapping_has_no_faults() -> None:
    assert read("{}") == FaultsDescription()


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_the_examples_can_be_read(path: Path) -> None:
    assert read_faults(path).value.messages


BAD = {
    "messages: [{topic: /scan}]": "1:12: messages[0]: this does nothing: give loss, duplication, latency or jitter",
    "messages: [{topic: a, los: 1}]": "1:23: messages[0].los: unknown key 'los' (did you mean 'loss'?)",
    "messages: [{loss: 1.5}]": "1:19: messages[0].loss: expected float <= 1.0, got '1.5'",
    "messages: [{loss: 5%}]": "1:19: messages[0].loss: expected float, got '5%'",
    "messages: [{latency: -1}]": "1:22: messages[0].latency: expected float >= 0.0, got '-1'",
    "messages: [{latency: .inf}]": "1:22: messages[0].latency: expected float <= 1000000000.0, got '.inf'",
    "messages: [{loss: .nan}]": "1:19: messages[0].loss: expected float >= 0.0, got '.nan'",
    "messages: [{topic: a, service: b, loss: 1}]": (
        "1:32: messages[0].service: a fault is on topics or on services: make two of it"
    ),
    "messages: [{service: b, duplication: 1}]": (
        "1:38: messages[0].duplication: a call is never doubled, only late or lost"
    ),
    "messages: [{latency: 1, reorder: true}]": "1:34: messages[0].reorder: without jitter nothing overtakes",
    "messages: [{latency: 1, burst: 3}]": "1:32: messages[0].burst: without loss there are no bursts of it",
    "messages: [{loss: 0.9, burst: 3}]": (
        "1:31: messages[0].burst: a loss of 0.9 leaves no room between bursts of 3: give at least 9"
    ),
    "messages: [{loss: 1, burst: 3}]": (
        "1:29: messages[0].burst: a loss of 1 leaves no room between bursts of 3: all is lost anyway"
    ),
    "messages: [{loss: 1, after: 9, until: 9}]": (
        "1:39: messages[0].until: expected a time later than 9 s, when it begins, got 9"
    ),
    "messages: [{topic: a b, loss: 1}]": (
        "1:20: messages[0].topic: 'a b' is not a name: it has a-z, A-Z, digits, _ and /,"
        " and * or ** for what may stand there"
    ),
    "messages: [{to: [a, ''], loss: 1}]": (
        "1:21: messages[0].to[1]: '' is not a name: it has a-z, A-Z, digits, _ and /,"
        " and * or ** for what may stand there"
    ),
    "partitions: [{between: [[a]]}]": (
        "1:24: partitions[0].between: expected two groups of nodes or more, such as [[world], [follower]]"
    ),
    "partitions: [{between: [[a], []]}]": (
        "1:24: partitions[0].between: expected two groups of nodes or more, such as [[world], [follower]]"
    ),
    "partitions: [{between: [[a], [b, /a]]}]": "1:24: partitions[0].between: 'a' is named twice",
    "partitions: [{between: [a, b], after: 2, until: 1}]": (
        "1:49: partitions[0].until: expected a time later than 2 s, when it begins, got 1"
    ),
    "partitions: [{}]": "1:14: partitions[0]: missing key 'between'",
    "crashes: [{node: a}]": "1:11: crashes[0]: missing key 'at'",
    "crashes: [{node: 'a*', at: 1}]": "1:18: crashes[0].node: one node crashes: 'a*' may be several",
    "crashes: [{node: a, at: -1}]": "1:25: crashes[0].at: expected float >= 0.0, got '-1'",
    "clocks: [{node: a}]": "1:10: clocks[0]: this clock is right: give offset or drift",
    "clocks: [{node: a, offset: 1}, {node: [b, /a], drift: 0.1}]": (
        "1:43: clocks[1].node[1]: the clock of '/a' is wrong already: say in one place all that it is"
    ),
    "clocks: [{node: a, drift: 2}]": "1:27: clocks[0].drift: expected float <= 0.1, got '2'",
    "clocks: [{node: a, offset: .nan}]": "1:28: clocks[0].offset: expected float >= -1000000000.0, got '.nan'",
    "messages: [{topic: a, qux: 1}]": "1:23: messages[0].qux: unknown key 'qux'; there are topic, service, from, to, "
    "loss, burst, duplication, latency, jitter, reorder, after, until",
    "message: []": "1:1: message: unknown key 'message' (did you mean 'messages'?)",
    "seed: x": "1:7: seed: expected int | nothing, got 'x'",
}


@pytest.mark.parametrize(("text", "told"), BAD.items(), ids=range(len(BAD)))
def test_what_is_told_of_a_bad_file(text: str, told: str) -> None:
    with pytest.raises(DocumentError) as caught:
        read(text)
    assert str(caught.value) == f"f.yaml:{told}"


def test_a_node_that_is_not_there_is_told_with_its_place_and_the_nearest() -> None:
    document = read_faults("f.yaml", text=ALL)
    known = {"world", "ada/wall_follower", "teleop"}
    with pytest.raises(DocumentError) as caught:
        check_nodes(document, known)
    place = "f.yaml:6:24: messages[1].to[0]: "
    assert str(caught.value) == place + "no node named 'wall_follower' (did you mean 'ada/wall_follower'?)"
    check_nodes(document, {*known, "wall_follower"})


@pytest.mark.parametrize(
    ("pattern", "fits", "fits_not"),
    [
        ("/scan", ["/scan", "scan"], ["/ada/scan", "/scanner"]),
        ("scan", ["/scan"], ["/ada/scan"]),
        ("/robot*/scan", ["/robot1/scan", "/robot/scan"], ["/robot/a/scan", "/robot1/scans"]),
        ("*/scan", ["/ada/scan"], ["/scan", "/a/b/scan"]),
        ("**/scan", ["/scan", "/ada/scan", "/a/b/scan"], ["/ascan"]),
        ("/ada/**", ["/ada", "/ada/scan", "/ada/b/c"], ["/adam", "/x/ada"]),
        ("**", ["/scan", "/a/b"], []),
    ],
)
def test_names_with_wildcards(pattern: str, fits: list[str], fits_not: list[str]) -> None:
    fit = matcher((pattern,))
    assert [fit(name) for name in fits] == [True] * len(fits)
    assert [fit(name) for name in fits_not] == [False] * len(fits_not)


DATA = st.recursive(
    st.none() | st.booleans() | st.floats() | st.integers() | st.text(max_size=8),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=8), inner, max_size=3),
    max_leaves=8,
)
KEYS = MessageFault.__struct_encode_fields__


@given(st.fixed_dictionaries({"messages": st.lists(st.dictionaries(st.sampled_from(KEYS), DATA, max_size=4))}) | DATA)
def test_whatever_a_file_says_it_is_read_or_told_in_one_line(data: object) -> None:
    told = "f.yaml:"
    try:
        read(spell(data))  # type: ignore[arg-type]
    except DocumentError as error:
        told = str(error)
    assert told.startswith("f.yaml:")
    assert "\n" not in told
