"""tf tree: what it shows of the frames, and what it tells when something is wrong with them."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink import Node
from robolink.cli.main import main
from robolink.cli.tf import tree, watch
from robolink.cli.tf.watch import Seen
from robolink.graph.graph import Graph
from robolink.interfaces.tf2_msgs.msg import TFMessage
from robolink.tf2 import StaticTransformBroadcaster
from tests.support.seen_by_commands import latch, made
from tests.support.transforms import transform

Captured = pytest.CaptureFixture[str]

S = 10**9


def static(node: Node, *transforms: Any) -> None:
    StaticTransformBroadcaster(node).sendTransform(transforms)


def test_the_tree_is_drawn(node: Node, again: Callable[..., None], capsys: Captured) -> None:
    again(transform("odom", "base"))
    again(transform("map", "odom"), by=made(node.context, "slam"))
    static(made(node.context, "fixed"), transform("base", "lidar"), transform("base", "imu"), transform("odom", "dock"))
    assert main(["tf", "tree", "-t", "0.4"]) == 0
    out, err = capsys.readouterr()
    assert err == ""
    lines = out.splitlines()
    assert lines[0] == "map"
    moving = r" +(?:[\d.]+ Hz|once) +-?\d\.\d\d s  "
    assert [re.sub(moving, " * ", line) for line in lines[1:]] in (
        [
            "└─ odom * /slam",
            "   ├─ base * /lab/robot",
            "   │  ├─ lidar  static                /fixed",
            "   │  └─ imu    static                /fixed",
            "   └─ dock      static                /fixed",
        ],
        [
            "└─ odom * /slam",
            "   ├─ dock      static                /fixed",
            "   └─ base * /lab/robot",
            "      ├─ lidar  static                /fixed",
            "      └─ imu    static                /fixed",
        ],
    )


def test_the_tree_says_what_is_wrong(node: Node, again: Callable[..., None], capsys: Captured) -> None:
    other = made(node.context, "other")
    again(transform("odom", "base"), transform("x", "x"))
    again(transform("map", "base"), transform("rig", "camera"), by=other, age=5.0)
    again(transform("rig", "camera"), age=5.0)
    assert main(["tf", "tree", "-t", "0.4", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert sorted(found["roots"]) in (["map", "rig"], ["odom", "rig"])
    reported = "\n".join(found["problems"])
    assert re.search(r"'base' has 2 parents: '\w+' \(from /[\w/]+\) and '\w+' \(from /[\w/]+\): lookups jump", reported)
    assert "'camera' is published by /lab/robot and /other: they overwrite each other" in reported
    assert re.search(r"'camera' is old: its last transform is of \d\.\d s ago", reported)
    assert "2 trees that nothing connects" in reported
    assert re.search(
        r"refused \d+ of 'x' -> 'x' from /lab/robot: TF_SELF_TRANSFORM: parent and child are one", reported
    )


def test_the_tree_as_a_graph(node: Node, capsys: Captured) -> None:
    static(node, transform("map", "base"))
    assert main(["tf", "tree", "-t", "0.2", "--dot"]) == 0
    out = capsys.readouterr().out
    assert out.startswith('digraph G {\n"map" -> "base"[label="Broadcaster: /lab/robot\\n')
    assert out.endswith("}\n")


def test_other_topics_may_be_listened_to(node: Node, capsys: Captured) -> None:
    latch(node, "/old/static", TFMessage(transforms=[transform("a", "b")]))
    assert main(["tf", "tree", "-t", "0.2", "--tf-static-topic", "/old/static"]) == 0
    assert capsys.readouterr().out.splitlines()[0] == "a"


def test_a_tree_of_nothing_says_why(node: Node, capsys: Captured) -> None:
    assert main(["tf", "tree", "-t", "0.1"]) == 1
    assert capsys.readouterr() == (
        "",
        "robolink: no transforms within 0.1 s; waiting for a publisher of /tf: nobody publishes it on domain 7 yet\n",
    )
    StaticTransformBroadcaster(node)
    assert main(["tf", "tree", "-t", "0.1"]) == 1
    assert "/tf_static is published by /lab/robot, which has sent nothing yet" in capsys.readouterr().err
    assert main(["tf", "tree", "--dot", "--json"]) == 2


def test_who_is_announced_behind_its_transforms_is_named_all_the_same(
    node: Node, again: Callable[..., None], monkeypatch: pytest.MonkeyPatch, capsys: Captured
) -> None:
    static(node, transform("map", "odom"))
    again(transform("odom", "base"))
    asked: list[bytes] = []
    known = Graph.endpoint_of

    def late(graph: Graph, gid: bytes) -> Any:
        """The first that is asked for is never announced, all others when they are asked for the third time."""
        asked.append(gid)
        return known(graph, gid) if gid != asked[0] and asked.count(gid) > 2 else None

    monkeypatch.setattr(Graph, "endpoint_of", late)
    monkeypatch.setattr(tree, "NAMED_WITHIN", 0.1)
    assert main(["tf", "tree", "-t", "0.2", "--json"]) == 0
    frames = json.loads(capsys.readouterr().out)["frames"]
    [unknown], [known_by_name] = sorted(
        (each["publishers"] for each in frames), key=lambda each: "unknown" not in each[0]
    )
    assert unknown == f"an unknown node ({asked[0].hex()[:8]})"
    assert known_by_name == node.get_fully_qualified_name()


def test_names_do_not_move_the_terminal(node: Node, capsys: Captured) -> None:
    static(node, transform("a\x1b[2J", "b\n"))
    assert main(["tf", "tree", "-t", "0.2"]) == 0
    assert "\x1b" not in capsys.readouterr().out


def seen(child: str, parent: str, *stamps: float, sender: str = "/a", fixed: bool = False) -> Seen:
    made_ = Seen(child, parent, sender, fixed)
    for at, stamp in enumerate(stamps):
        made_.add(int(stamp * S), 100 * S + at * S // 10)
    return made_


def reported(*links: Seen, now: float = 100.0) -> list[str]:
    found = tree.nodes(list(links), int(now * S))
    return list(tree.problems(found, list(links)))


def test_nothing_is_wrong_with_a_good_tree() -> None:
    assert reported(seen("b", "a", 99.8, 99.9, 100), seen("c", "b", 0, fixed=True)) == []


def test_stamps_of_another_clock_are_compared_to_each_other() -> None:
    sim = seen("b", "a", 5.0, 5.1), seen("c", "b", 1.0, 1.1)
    assert tree.reference(list(sim), 100 * S) == int(5.1 * S)
    assert reported(*sim) == ["'c' is old: its last transform is of 4.0 s ago"]


def test_a_slow_frame_is_not_old() -> None:
    slow = Seen("b", "a", "/a", False)
    for second in (80, 90, 98):
        slow.add(second * S, second * S)
    assert reported(slow) == []


def test_frames_without_stamps_and_frames_of_the_future() -> None:
    assert reported(seen("b", "a", 0, 0)) == ["'b' has no stamps: all are 0, so that only the latest can be looked up"]
    assert reported(seen("b", "a", 103, 104)) == ["'b' is ahead of time: its last transform is of 4.0 s from now"]


def test_static_and_moving_at_once() -> None:
    both = seen("b", "a", 99.9, 100), seen("b", "a", 0, sender="/z", fixed=True)
    assert "'b' is both static and moving: each makes a buffer forget the other" in reported(*both)


@given(
    st.lists(st.tuples(st.sampled_from("abcdef"), st.sampled_from("abcdef")).filter(lambda e: e[0] != e[1]), min_size=1)
)
def test_every_frame_is_drawn_once_whatever_is_sent(edges: list[tuple[str, str]]) -> None:
    links = list({(child, parent): seen(child, parent, 100) for child, parent in edges}.values())
    found = tree.nodes(links, 100 * S)
    shown = [line.lstrip("│├└─ ")[0] for line in tree.lines(found)]
    wanted = {name for each in found.values() for name in (each.name, each.link.parent)}
    assert sorted(shown) == sorted(wanted)
    list(tree.problems(found, links))


def test_what_a_link_remembers_is_bounded() -> None:
    link = Seen("b", "a", "/a", False)
    for at in range(3000):
        link.add(at, at)
    assert len(link.stamps) == len(link.arrivals) == watch.LAST
