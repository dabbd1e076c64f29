"""Counterparts of joy and joy_linux: the state of a gamepad as messages."""
