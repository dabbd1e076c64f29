"""Helps that Nav2's counterparts share: action servers with preemption, the robot's pose, parameters of a file."""
