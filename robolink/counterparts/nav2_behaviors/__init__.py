"""Counterpart of nav2_behaviors: small drives that free a robot, each an action that looks for collisions first."""
