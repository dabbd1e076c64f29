"""iRobot's irobot_create_msgs: sensors, lights, sounds and movements of a Create 3."""
