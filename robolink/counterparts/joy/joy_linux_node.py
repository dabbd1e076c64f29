"""Publish the state of a gamepad on /joy, with the parameters of joy_linux.

robolink run joy_linux joy_linux_node --ros-args -p dev:=/dev/input/js0
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from robolink.counterparts.joy.devices import found_gamepads, named
from robolink.counterparts.joy.joy_node import JoyNode
from robolink.counterparts.program import spin_program


class JoyLinuxNode(JoyNode):
    """A node that publishes the state of the gamepad `dev`. `options` are those of `JoyNode`."""

    def __init__(self, **options: Any) -> None:
        super().__init__("joy_node", **options)

    def declare_device(self) -> None:
        """Declare the parameters that say which gamepad it is."""
        self._device = self._declare("dev", "/dev/input/js0", "device of the gamepad")
        self._id = -1
        self._name = self._declare("dev_name", "", "name of the gamepad, which goes before its device")
        self._declare("coalesce_interval", 0.001, "of no effect: changes within 5 ms are one message")
        self._declare("default_trig_val", False, "of no effect: the kernel tells where the triggers are")

    def path(self) -> Path | None:
        """Return the device, if it is there."""
        if self._name:
            return next((each for each in found_gamepads().values() if named(each) == self._name), None)
        path = Path(self._device)
        return path if path.exists() else None


def main(args: list[str] | None = None) -> None:
    """Publish the state of a gamepad until Ctrl-C."""
    spin_program(lambda words: JoyLinuxNode(), args)


if __name__ == "__main__":
    main()
