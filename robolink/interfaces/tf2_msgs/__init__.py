"""ROS 2's tf2_msgs: what /tf and /tf_static carry."""
