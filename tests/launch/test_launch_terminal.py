"""Bytes that `robolink launch` writes to a terminal: a real one, with real nodes."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from robolink.extensions.optional import PAGE, is_here

PATIENCE = 30.0
ODD = """
import sys
import rclpy
from rclpy.node import Node

rclpy.init()
node = Node("odd")
node.get_logger().warn("low battery, \\u00e9 \\U0001f916")
print("printed", flush=True)
for percent in (1, 50, 100):
    print(f"\\r{percent} %", end="", flush=True)
print("\\n" + "x" * 300 + "\\nhalf a line, then", end=" ", flush=True)
raise KeyError("speed")
"""
TIME = r"\x1b\[2m *\d+\.\d s\x1b\[0m  "


def on_terminal(folder: Path, *words: str, **environ: str) -> str:
    """Run robolink with a terminal of 80 columns as its output, until it ends; return what it wrote."""
    if sys.platform == "win32":
        pytest.skip("pseudo-terminals are POSIX's")
    import fcntl
    import struct
    import termios

    ours, theirs = os.openpty()
    fcntl.ioctl(theirs, termios.TIOCSWINSZ, struct.pack("HHHH", 24, 80, 0, 0))
    apart = ("NO_COLOR", "DISPLAY", "WAYLAND_DISPLAY", "SSH_CONNECTION")
    plain = {name: value for name, value in os.environ.items() if name not in apart}
    with subprocess.Popen(
        [sys.executable, "-m", "robolink", *words],
        cwd=folder,
        env={**plain, "TERM": "xterm", **environ},
        stdin=subprocess.DEVNULL,
        stdout=theirs,
        stderr=theirs,
    ) as process:
        os.close(theirs)
        written = b""
        try:
            while part := os.read(ours, 65536):
                written += part
        except OSError:  # how a terminal says on Linux that nobody has it any more
            pass
        finally:
            os.close(ours)
        process.wait(PATIENCE)
    return written.decode().replace("\r\n", "\n")


@pytest.mark.processes
def test_lines_of_a_launch_on_a_terminal(home: Path, domain: int) -> None:
    (home / "nodes" / "odd.py").write_text(ODD, encoding="utf-8")
    (home / "configs" / "odd.yaml").write_text("nodes: [node: odd]\n")
    lines = on_terminal(home, "launch", "odd", ROS_DOMAIN_ID=str(domain)).splitlines()
    odd, launch = "\x1b[36modd\x1b[0m   ", "\x1b[1mlaunch\x1b[0m"
    shown = [re.sub(f"^{TIME}", "", each.removeprefix("\r")) for each in lines if each]
    if is_here(PAGE) and sys.platform == "linux":  # a Mac has a screen
        assert shown.pop(0) == f"INFO  {launch}  no browser here: to see the system, `robolink view` in another shell"
    assert shown[:6] == [
        f"\x1b[33mWARN \x1b[0m {odd}  \x1b[33mlow battery, \u00e9 \U0001f916\x1b[0m",
        f"      {odd}  printed",
        f"      {odd}  100 %",
        f"      {odd}  {'x' * 300}",
        f"      {odd}  half a line, then Traceback (most recent call last):",
        f'      {odd}    File "{home}/nodes/odd.py", line 13, in <module>',
    ]
    assert f"      {odd}  KeyError: 'speed'" in shown
    error = f"\x1b[31mERROR\x1b[0m {launch}  \x1b[31modd ended with exit code 1: KeyError: 'speed'\x1b[0m"
    assert shown[-2] == error
    assert shown[-1].startswith(f"INFO  {launch}  logs: ")
