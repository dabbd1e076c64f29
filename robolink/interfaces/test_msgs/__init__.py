"""ROS 2's test_msgs: types that have one of everything, for tests."""
