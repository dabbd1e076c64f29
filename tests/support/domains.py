"""Unused ROS domain ids, for tests that communicate over Zenoh."""

from robolink.transport.free_domain import free_domain

__all__ = ["free_domain"]
