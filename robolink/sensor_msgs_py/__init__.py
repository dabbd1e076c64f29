"""Package sensor_msgs_py of ROS 2: point clouds as numpy arrays."""
