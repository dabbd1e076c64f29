"""ROS's octomap_msgs: occupancy maps in three dimensions, as octrees."""
