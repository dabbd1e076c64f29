"""ROS 2's service_msgs: what service introspection says of a call."""
