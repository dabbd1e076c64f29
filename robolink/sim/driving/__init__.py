"""How robots are driven: limits, forces onto exact arcs, wheels, odometry; one by one or all at once."""
