"""ROS 2's rcl_interfaces: parameters and logging between nodes."""
