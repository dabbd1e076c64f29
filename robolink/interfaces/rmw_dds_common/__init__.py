"""ROS 2's rmw_dds_common: how nodes over DDS tell each other what they have."""
