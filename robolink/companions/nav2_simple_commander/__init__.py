"""nav2_simple_commander: a plain script sends a robot around by the actions and services of Nav2."""
