"""Python packages of ROS 2 other than rclpy: message_filters, cv_bridge, rosbag2_py, nav2_simple_commander, others."""
