"""Bags: recorded topics in files that ROS 2's tools read and write."""
