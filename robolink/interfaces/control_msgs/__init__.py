"""ros2_control's control_msgs: commands to controllers, and what controllers report."""
