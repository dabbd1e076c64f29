"""Counterparts of executables of ROS packages, a sub-package for each: see `robolink.workspace.programs`."""
