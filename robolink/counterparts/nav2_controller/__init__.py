"""Counterpart of nav2_controller: it drives along a path, round what is in the way."""
