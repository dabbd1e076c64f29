"""ROS 2's nav_msgs: odometry, paths and maps."""
