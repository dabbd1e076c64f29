"""ROBOTIS's turtlebot3_msgs: the board of a TurtleBot3, and its examples."""
