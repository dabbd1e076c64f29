"""Output that is expected of a process, and processes for one test (`launch_testing.tools`)."""

from __future__ import annotations

from robolink.launch.ros.launch_testing import text
from robolink.launch.ros.launch_testing.tools import output, process
from robolink.launch.ros.launch_testing.tools.output import (
    basic_output_filter,
    expect_output,
    expected_output_from_file,
)
from robolink.launch.ros.launch_testing.tools.process import ProcessProxy, launch_process

__all__ = [
    "ProcessProxy",
    "basic_output_filter",
    "expect_output",
    "expected_output_from_file",
    "launch_process",
    "output",
    "process",
    "text",
]
