"""ROS 2's action_tutorials_interfaces: the action of the tutorials."""
