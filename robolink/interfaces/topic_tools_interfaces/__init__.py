"""ROS's topic_tools_interfaces: services of a multiplexer and a demultiplexer of topics."""
