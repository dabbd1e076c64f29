"""Counterpart of nav2_planner: paths through the global costmap."""
