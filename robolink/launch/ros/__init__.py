"""ROS 2 launch files: runs a description of `launch` and `launch_ros` and makes the entries that are to start.

`reading` loads a file and makes its first entries; `visit` executes a description's actions one by one; `entries`,
`programs` and `parameters` turn actions into entries. Nothing of this is imported for robolink's own YAML.
"""
