"""A first node: its timer ticks once a second, and it says hello."""

import contextlib
from typing import Any

import robolink
from robolink import Node
from robolink.exceptions import ExternalShutdownException
from robolink.parameters.descriptors import described


class FirstNode(Node):
    """A node that logs a greeting at each tick of its timer, with a count.

    The greeting is a parameter. Change it while the node runs: robolink param set /first_node greeting 'good morning'
    """

    def __init__(self, **options: Any) -> None:
        super().__init__("first_node", **options)
        self.declare_parameter("greeting", "hello", described("what it says"))
        self.count = 0
        self.create_timer(1.0, self.on_timer)
        self.get_logger().info("first_node is there")

    def on_timer(self) -> None:
        """Log the greeting once more."""
        self.count += 1
        greeting = self.get_parameter("greeting").value
        self.get_logger().info(f"{greeting}, for the {ordinal(self.count)} time")


def ordinal(number: int) -> str:
    """Return a number as an ordinal: 1st, 2nd, 3rd, 4th ... 11th, 12th, 13th ... 21st."""
    ending = {1: "st", 2: "nd", 3: "rd"}.get(number % 10, "th")
    return f"{number}{'th' if number % 100 in (11, 12, 13) else ending}"


def main(args: list[str] | None = None) -> None:
    """Start robolink, run the node until Ctrl-C, and end robolink."""
    with robolink.init(args=args), contextlib.suppress(KeyboardInterrupt, ExternalShutdownException):
        robolink.spin(FirstNode())


if __name__ == "__main__":
    main()
