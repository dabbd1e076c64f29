"""rosbridge_suite's rosapi_msgs: questions about topics, services, nodes and parameters, as browsers ask them."""
