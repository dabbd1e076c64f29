"""Command-line arguments of a ROS program: remappings, parameter overrides and files, log levels."""
