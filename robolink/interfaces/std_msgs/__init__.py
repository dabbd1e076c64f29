"""ROS 2's std_msgs: the header of stamped messages, and single values."""
