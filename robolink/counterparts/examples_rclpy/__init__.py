"""Counterparts of the packages examples_rclpy_minimal_*: the smallest programs with topics, services and actions."""
