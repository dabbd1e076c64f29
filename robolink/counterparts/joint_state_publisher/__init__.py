"""Counterpart of joint_state_publisher: positions for all joints of a robot model."""
