"""Counterpart of slam_toolbox: a map of a lidar's scans, and where the robot is in it (simultaneous localization)."""
