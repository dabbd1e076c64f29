"""Counterpart of robot_state_publisher: the transforms of a robot model, from its joints' positions."""
