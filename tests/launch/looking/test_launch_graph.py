"""A system is drawn as text that Mermaid and Graphviz read: nodes, and what goes from one to another."""

from __future__ import annotations

import re
from pathlib import Path

from hypothesis import given
from hypothesis import strategies as st

from robolink.launch import Entry, read_launch_file
from robolink.launch.looking.graph import drawn
from robolink.launch.looking.look import End, Look

SCAN, TWIST, TRIGGER = "sensor_msgs/msg/LaserScan", "geometry_msgs/msg/Twist", "std_srvs/srv/Trigger"
GOAL = "nav2_msgs/action/NavigateToPose"


def entries(*names: str) -> list[Entry]:
    text = "nodes:\n" + "\n".join(f"- {{node: world, name: {name}}}" for name in names)
    return read_launch_file(Path("lap.yaml"), text=text)


def look(node: str, *ends: tuple[str, str, str]) -> Look:
    everybodys = [
        End("MP", "/rosout", "rcl_interfaces/msg/Log", "", node),
        End("MP", "/parameter_events", "rcl_interfaces/msg/ParameterEvent", "", node),
        End("SS", f"{node}/get_parameters", "rcl_interfaces/srv/GetParameters", "", node),
        End("SS", f"{node}/get_type_description", "type_description_interfaces/srv/GetTypeDescription", "", node),
    ]
    return Look([node], [*everybodys, *(End(kind, name, type_name, "", node) for kind, name, type_name in ends)])


LOOKS = {
    "world": look("/world", ("MP", "/scan", SCAN), ("MS", "/cmd_vel", TWIST), ("SS", "/world/reset", TRIGGER)),
    "driver": look(
        "/driver",
        ("MS", "/scan", SCAN),
        ("MP", "/cmd_vel", TWIST),
        ("SC", "/world/reset", TRIGGER),
        ("SS", "/nobody/calls", TRIGGER),
        ("SS", "/go/_action/send_goal", f"{GOAL}_SendGoal"),
        ("SS", "/go/_action/get_result", f"{GOAL}_GetResult"),
        ("MP", "/go/_action/status", "action_msgs/msg/GoalStatusArray"),
    ),
    "planner": look(
        "/planner",
        ("SC", "/go/_action/send_goal", f"{GOAL}_SendGoal"),
        ("MS", "/go/_action/status", "action_msgs/msg/GoalStatusArray"),
    ),
}


def test_mermaid() -> None:
    text = drawn(entries("world", "driver", "planner", "dark"), LOOKS)
    assert text == (
        "flowchart LR\n"
        '    n0["/world"]\n'
        '    n1["/driver"]\n'
        '    n2["/planner"]\n'
        '    n3["/dark"]\n'
        f'    p0[["/go<br/>{GOAL}"]]\n'
        f'    p1{{{{"/world/reset<br/>{TRIGGER}"}}}}\n'
        f'    p2(["/cmd_vel<br/>{TWIST}"])\n'
        f'    p3(["/scan<br/>{SCAN}"])\n'
        "    p0 -.-> n1\n"
        "    n1 -.-> p1\n"
        "    n1 --> p2\n"
        "    p3 --> n1\n"
        "    n2 -.-> p0\n"
        "    p1 -.-> n0\n"
        "    p2 --> n0\n"
        "    n0 --> p3\n"
    )


def test_dot() -> None:
    text = drawn(entries("world", "driver"), {name: LOOKS[name] for name in ("world", "driver")}, "dot")
    assert text == (
        "digraph system {\n"
        "    rankdir=LR;\n"
        '    "node /world" [label="/world", shape=box];\n'
        '    "node /driver" [label="/driver", shape=box];\n'
        f'    "service /world/reset {TRIGGER}" [label="/world/reset\\n{TRIGGER}", shape=hexagon];\n'
        f'    "topic /cmd_vel {TWIST}" [label="/cmd_vel\\n{TWIST}", shape=ellipse];\n'
        f'    "topic /scan {SCAN}" [label="/scan\\n{SCAN}", shape=ellipse];\n'
        f'    "node /driver" -> "service /world/reset {TRIGGER}" [style=dashed];\n'
        f'    "node /driver" -> "topic /cmd_vel {TWIST}";\n'
        f'    "topic /scan {SCAN}" -> "node /driver";\n'
        f'    "service /world/reset {TRIGGER}" -> "node /world" [style=dashed];\n'
        f'    "topic /cmd_vel {TWIST}" -> "node /world";\n'
        f'    "node /world" -> "topic /scan {SCAN}";\n'
        "}\n"
    )


@given(st.lists(st.tuples(st.sampled_from(["MP", "MS", "SS", "SC"]), st.text(min_size=1), st.text())), st.text())
def test_no_name_breaks_out_of_its_label(ends: list[tuple[str, str, str]], node: str) -> None:
    looks = {"world": look(node, *ends)}
    dot = re.sub(r'"(?:[^"\\]|\\.)*"', "", drawn(entries("world"), looks, "dot"), flags=re.DOTALL)
    assert re.fullmatch(r"digraph system \{\n    rankdir=LR;\n(?:     (?:\[.*\]|->  ?(?:\[.*\])?);\n)*\}\n", dot)
    mermaid = re.sub(r'"[^"]*"', "", drawn(entries("world"), looks))
    shape = r"n\d+\[\]|p\d+(?:\(\[\]\)|\{\{\}\}|\[\[\]\])|[np]\d+ -(?:\.-|-)> [np]\d+"
    assert re.fullmatch(rf"flowchart LR\n(?:    (?:{shape})\n)*", mermaid)
