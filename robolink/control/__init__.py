"""Controllers for robots: PID, laser scans by angle, the way to a pose, and a node to extend that drives by scans."""
