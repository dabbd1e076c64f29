"""Counterpart of the ROS package turtlesim: turtles that draw with pens, for first steps and tutorials."""
