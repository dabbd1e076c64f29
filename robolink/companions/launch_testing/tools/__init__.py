"""Helpers of launch tests (`launch_testing.tools`)."""

from robolink.companions.launch_testing.tools.output import basic_output_filter, expected_output_from_file
from robolink.companions.launch_testing.tools.process import ProcessProxy, launch_process

__all__ = ["ProcessProxy", "basic_output_filter", "expected_output_from_file", "launch_process"]
