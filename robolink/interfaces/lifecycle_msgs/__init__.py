"""ROS 2's lifecycle_msgs: the states of a managed node, and the steps between them."""
