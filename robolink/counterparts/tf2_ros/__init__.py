"""Counterparts of programs of tf2_ros that are nodes."""
