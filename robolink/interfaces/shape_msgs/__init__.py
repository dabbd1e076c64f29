"""ROS 2's shape_msgs: solid bodies, meshes and planes."""
