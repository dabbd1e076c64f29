"""ROS 2's visualization_msgs: what rviz shows, and what one can drag there."""
