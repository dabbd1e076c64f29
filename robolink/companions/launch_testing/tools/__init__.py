"""Helpers of launch tests (`launch_testing.tools`)."""

from robolink.companions.launch_testing.tools.output import basic_output_filter, expected_output_from_file

__all__ = ["basic_output_filter", "expected_output_from_file"]
