"""ROS 2's std_srvs: services that need no types of their own."""
