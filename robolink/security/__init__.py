"""Security by the names that ROS 2 has: keystores, policies and rights of enclaves, and what Zenoh makes of them."""
