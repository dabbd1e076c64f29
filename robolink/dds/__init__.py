"""ROS 2 over DDS: its names, types, graph and calls on an RTPS participant, and the mirror between two networks."""
