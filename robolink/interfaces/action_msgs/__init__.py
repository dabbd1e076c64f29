"""ROS 2's action_msgs: what all actions share, the states of goals and their cancelling."""
