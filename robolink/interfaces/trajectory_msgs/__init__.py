"""ROS 2's trajectory_msgs: how joints shall move over time."""
