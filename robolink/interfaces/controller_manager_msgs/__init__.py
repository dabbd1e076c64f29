"""ros2_control's controller_manager_msgs: controllers and hardware, and switching them."""
