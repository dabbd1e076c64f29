"""Nodes that reach differently far, in one process: for each line of standard input, those that each of them sees."""

import json
import os
import sys

import rclpy
from rclpy.context import Context

VARIABLES = ("ROS_AUTOMATIC_DISCOVERY_RANGE", "ROS_STATIC_PEERS", "ROBOLINK_DDS_INTERFACE")


def node_with(name, environ):
    for each in VARIABLES:
        os.environ.pop(each, None)
    os.environ.update(environ)
    context = Context()
    rclpy.init(context=context)
    return rclpy.create_node(name, context=context)


nodes = {name: node_with(name, environ) for name, environ in json.loads(sys.argv[1]).items()}
print("ready", flush=True)
for _ in sys.stdin:
    print(json.dumps({name: sorted(node.get_node_names()) for name, node in nodes.items()}), flush=True)
