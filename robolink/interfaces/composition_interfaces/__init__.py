"""ROS 2's composition_interfaces: nodes loaded into a running process."""
