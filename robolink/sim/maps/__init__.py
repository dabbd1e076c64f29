"""Maps of ROS's map_server: a YAML file and its image become walls."""
