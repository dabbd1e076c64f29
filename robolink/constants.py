"""Numbers that several rooms share."""

S_TO_NS = 1_000_000_000
"""Nanoseconds in one second."""
