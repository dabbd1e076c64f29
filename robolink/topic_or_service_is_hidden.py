"""Hidden topics and services, which `topic list` leaves out."""

from __future__ import annotations

HIDDEN_TOPIC_PREFIX = "_"


def topic_or_service_is_hidden(name: str) -> bool:
    """True if any token of `name` begins with '_', as in '/robot/_action/status'."""
    return any(token.startswith(HIDDEN_TOPIC_PREFIX) for token in name.split("/"))
