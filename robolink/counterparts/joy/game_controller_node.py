"""Publish the state of a gamepad on /joy, in an order of axes and buttons that is one for all gamepads.

robolink run joy game_controller_node
"""

from __future__ import annotations

from typing import Any

from robolink.counterparts.joy.joy_node import JoyNode
from robolink.counterparts.joy.layout import ControllerState
from robolink.counterparts.program import spin_program


class GameControllerNode(JoyNode):
    """A node that publishes six axes and 21 buttons. `options` are those of `JoyNode`."""

    made_state = ControllerState

    def __init__(self, **options: Any) -> None:
        super().__init__("game_controller_node", **options)


def main(args: list[str] | None = None) -> None:
    """Publish the state of a gamepad until Ctrl-C."""
    spin_program(lambda words: GameControllerNode(), args)


if __name__ == "__main__":
    main()
