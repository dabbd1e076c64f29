"""ROS's apriltag_msgs: AprilTags that a camera sees."""
