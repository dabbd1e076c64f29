"""launch_xml and launch_yaml: ROS 2's launch files in XML and YAML, which become the actions of `launch`."""

from robolink.companions.launch_frontend.sources import XMLLaunchDescriptionSource, YAMLLaunchDescriptionSource

__all__ = ["XMLLaunchDescriptionSource", "YAMLLaunchDescriptionSource"]
