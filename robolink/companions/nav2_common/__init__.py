"""nav2_common: the substitutions with which launch files of Nav2 rewrite parameter files."""
