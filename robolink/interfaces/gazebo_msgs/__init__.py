"""Gazebo Classic's gazebo_msgs: entities of a simulated world, their states, and forces on them."""
