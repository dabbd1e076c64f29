"""Unused ROS domain ids, for tests that communicate over Zenoh."""

from robolink.transport.port_sharing import free_domain

__all__ = ["free_domain"]
