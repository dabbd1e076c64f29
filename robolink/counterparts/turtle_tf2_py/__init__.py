"""Counterpart of the ROS package turtle_tf2_py: a turtle follows another one by tf2, as in the introduction to tf2."""
