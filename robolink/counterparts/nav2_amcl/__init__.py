"""Counterpart of nav2_amcl: where a robot is on a map, by a particle filter (adaptive Monte Carlo localization)."""
