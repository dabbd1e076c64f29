"""Nav2's nav2_msgs: actions that make a robot drive somewhere, costmaps, and services of Nav2's servers."""
