"""Programs for Webots drive robots of the simulated world: `webots_ros2_driver` by its own names."""
