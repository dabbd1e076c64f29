"""Clearpath's turtlebot4_msgs: buttons, lights and display of a TurtleBot 4."""
