"""Counterpart of webots_ros2_driver: the driver of one robot, with the plugins and devices that its URDF names."""
