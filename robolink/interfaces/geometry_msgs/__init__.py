"""ROS 2's geometry_msgs: points, poses, velocities and forces in space."""
