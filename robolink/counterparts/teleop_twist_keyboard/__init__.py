"""Counterpart of teleop_twist_keyboard: velocity commands by the keys of a terminal."""
