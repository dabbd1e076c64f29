"""ROS's vision_msgs: objects that a camera or a laser has detected, and what they were taken for."""
