"""Counterpart of nav2_bringup: launch files of a whole navigation, under Nav2's names, and their parameters."""
