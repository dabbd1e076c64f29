"""Counterpart of teleop_twist_joy: velocity commands from a gamepad."""
