"""Drive models of robots: limits, forces onto exact arcs, wheels, odometry; one by one or all at once."""
