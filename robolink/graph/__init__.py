"""The ROS graph: nodes and endpoints that are announced, the endpoints of this process, and how they match."""
