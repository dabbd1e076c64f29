"""ROS 2's rosgraph_msgs: the clock that a simulation publishes."""
