"""Counterparts of nav2_map_server: maps from files, and into files."""
