"""Gazebo's ros_gz_interfaces: entities of a simulated world, contacts, lights, and control of the world."""
