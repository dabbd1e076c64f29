"""ROS 2's diagnostic_msgs: how well the parts of a robot are."""
