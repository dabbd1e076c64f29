"""ROS 2's example_interfaces: types to learn and to try things out with."""
