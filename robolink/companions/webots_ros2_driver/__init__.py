"""webots_ros2_driver as launch files see it: actions that start a simulated world and the drivers of its robots.

Programs see `robolink.webots_controller` under the same name. `WebotsController` is a node there and an action here:
`robolink.compat.launch_files` decides which one is meant.
"""
