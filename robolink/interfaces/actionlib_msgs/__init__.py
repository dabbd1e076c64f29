"""ROS 2's actionlib_msgs: goals as ROS 1's actions had them, for bridges and old bags."""
