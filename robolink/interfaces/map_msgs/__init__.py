"""ROS's map_msgs: parts of maps, and changes to them."""
