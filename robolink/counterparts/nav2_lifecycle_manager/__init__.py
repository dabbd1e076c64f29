"""Counterpart of nav2_lifecycle_manager: it starts and ends managed nodes in order."""
