"""Counterparts of topic_tools: programs that pass on messages of any type as bytes."""
