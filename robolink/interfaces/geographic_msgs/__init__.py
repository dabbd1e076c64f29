"""ROS's geographic_msgs: positions on the Earth, and maps and routes made of them."""
