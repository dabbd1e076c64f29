"""ROS 2's sensor_msgs: what sensors measure."""
