"""Domains that nobody else on this machine uses now, for tests that talk over Zenoh."""

from robolink.transport.free_domain import free_domain

__all__ = ["free_domain"]
