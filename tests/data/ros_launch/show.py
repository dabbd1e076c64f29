#!/usr/bin/env python3
"""Program of the descriptions' nodes: appends what it was given, as a line of JSON, to the file $SHOWN, and ends."""

import json
import os
import sys
from pathlib import Path

import rclpy
from rclpy.node import Node
from rclpy.utilities import remove_ros_args


def seen(words):
    """Return the parameters and names of a node with this command line."""
    found = {"env": {name: value for name, value in sorted(os.environ.items()) if name.startswith("X_")}}
    try:
        found["args"] = remove_ros_args(words)[1:]
        rclpy.init(args=words)
        node = Node("show", automatically_declare_parameters_from_overrides=True, start_parameter_services=False)
    except Exception as error:
        return {**found, "error": type(error).__name__}
    given = sorted(set(node._parameters) - {"use_sim_time", "start_type_description_service"})
    if node.get_parameter("use_sim_time").value:
        given.append("use_sim_time")
    values = {name: node.get_parameter(name) for name in given}
    found["name"] = node.get_fully_qualified_name()
    found["parameters"] = {
        name: [each.type_.name, each.value if isinstance(each.value, (str, bool, int, float)) else list(each.value)]
        for name, each in values.items()
    }
    found["topics"] = [node.resolve_topic_name(name) for name in ("chatter", "scan")]
    return found


if __name__ == "__main__":
    line = json.dumps(seen(sys.argv), sort_keys=True, default=str)
    with Path(os.environ["SHOWN"]).open("a") as file:
        file.write(line + "\n")
    if "stay" in sys.argv:
        import signal

        signal.sigwait([signal.SIGINT, signal.SIGTERM])
    sys.stdout.flush()
    os._exit(next((int(each[5:]) for each in sys.argv if each.startswith("exit=")), 0))
