"""ROS 2's launch in one room: what its launch files import, and the walk that fills the plan of a system from them.

The folders have the names of ROS 2's packages: `launch`, `launch_ros`, `launch_xml`, `launch_yaml`, `launch_testing`;
`launch_frontend` is what XML and YAML share. Beside them is the walk: `visit` loads a file and executes its actions one
by one, `entries` and `programs` make the plan's entries of them, `reactions` goes on while the system runs, on a
`stage`. Nothing of this is imported for robolink's own YAML.
"""
