"""Python packages of ROS 2 other than rclpy: message_filters, rosidl_runtime_py, ament_index_python."""
