"""Counterparts of demo_nodes_cpp's programs that tutorials start, in Python."""
