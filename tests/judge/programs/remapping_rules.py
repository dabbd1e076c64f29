"""Remapping rules of every form, one after another: whether they are taken, and what becomes of names."""

from pathlib import Path

import rclpy
from probe import kind, say
from std_msgs.msg import String
from std_srvs.srv import Trigger


def names(rule):
    try:
        rclpy.init(args=["--ros-args", "-r", rule])
    except Exception as error:
        return f"raises {kind(error)}"
    try:
        node = rclpy.create_node("n")
        topics = [node.create_publisher(String, name, 1).topic_name for name in ("c", "a/b", "~/c")]
        services = [node.create_service(Trigger, name, print).service_name for name in ("c", "~/c")]
        return node.get_fully_qualified_name(), topics, services
    except Exception as error:
        return f"later raises {kind(error)}"
    finally:
        rclpy.shutdown()


for rule in Path(__file__).with_name("remapping_rules.txt").read_text(encoding="utf-8").splitlines():
    say(rule, names(rule))
