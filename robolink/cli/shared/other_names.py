"""Other names of the command: under each it is another program, as a copy of its launcher on Windows is."""

from __future__ import annotations

OTHER_NAMES = {"colcon": "robolink.cli.shim.colcon", "launch_test": "robolink.cli.shim.launch_test"}
"""Modules whose `main` runs in place of the command's own."""
