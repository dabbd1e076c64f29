"""Counterparts of demo_nodes_py: first programs with topics, services and parameters."""
