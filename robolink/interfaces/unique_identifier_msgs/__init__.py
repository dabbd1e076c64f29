"""ROS 2's unique_identifier_msgs: the name that no other thing has."""
