"""RTPS 2.x participant in pure Python, the protocol of DDS: it carries serialized samples and knows nothing of ROS."""
