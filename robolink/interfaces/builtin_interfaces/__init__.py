"""ROS 2's builtin_interfaces: points and spans of time."""
