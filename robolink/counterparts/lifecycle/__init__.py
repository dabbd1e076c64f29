"""Counterparts of the package lifecycle: the demo of managed nodes."""
