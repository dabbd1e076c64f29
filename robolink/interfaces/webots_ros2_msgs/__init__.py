"""The Webots simulator's webots_ros2_msgs: values of its devices, and robots to add to its world."""
