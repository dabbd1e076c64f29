# env: "RCUTILS_CONSOLE_OUTPUT_FORMAT={name}|{function_name}|{file_name}|{line_number}|{message}|{severity}"

"""The caller, file and line of a log message."""

import re
import sys

import rclpy

rclpy.init()
n = rclpy.create_node("n76")


class A:
    def method(self):
        n.get_logger().error("in method")


A().method()
(lambda: n.get_logger().error("in lambda"))()


def helper(text):
    n.get_logger().error(text)


helper("in helper")
