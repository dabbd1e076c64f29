"""ROS 2's ackermann_msgs: commands for cars."""
