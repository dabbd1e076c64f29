"""ROS 2's rosbag2_interfaces: remote control for players and recorders of bags."""
