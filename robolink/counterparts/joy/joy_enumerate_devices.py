"""List the gamepads of this machine by number and name."""

from __future__ import annotations

import sys

from robolink.counterparts.joy.devices import found_gamepads, named
from robolink.system.terminal import shown


def main() -> None:
    """Print a line for each gamepad."""
    rows = [f"{number:>18} : {shown(named(path))}" for number, path in found_gamepads().items()]
    lines = ["Joystick Device ID : Joystick Device Name", "-" * 41, *rows]
    sys.stdout.write("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
