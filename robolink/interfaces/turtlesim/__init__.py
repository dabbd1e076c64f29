"""ROS 2's turtlesim: the turtle of the tutorials."""
