"""ROS 2's stereo_msgs: depth from two cameras."""
