"""rosbridge_suite's rosbridge_msgs: the clients of a rosbridge server."""
