"""ROS's can_msgs: frames on a CAN bus."""
