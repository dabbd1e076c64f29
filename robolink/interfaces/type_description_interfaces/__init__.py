"""ROS 2's type_description_interfaces: what a type is made of, as messages."""
