"""ROS 2's statistics_msgs: what was measured of topics and processes."""
