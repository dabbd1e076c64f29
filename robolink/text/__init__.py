"""Text helpers: rules of ROS names, suggestions for misspelt names, tracebacks."""
