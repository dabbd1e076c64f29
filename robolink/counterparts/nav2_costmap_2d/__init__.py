"""Counterpart of nav2_costmap_2d: the costmap node, which Nav2's servers own."""
