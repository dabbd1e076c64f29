"""launch_xml and launch_yaml: ROS 2's launch files in XML and YAML, which become the actions of `launch`."""

from __future__ import annotations

from robolink.launch.ros.launch.bases import SomeSubstitutionsType
from robolink.launch.ros.launch.sources import FrontendLaunchDescriptionSource

__all__ = [
    "XMLLaunchDescriptionSource",
    "YAMLLaunchDescriptionSource",
]


class XMLLaunchDescriptionSource(FrontendLaunchDescriptionSource):
    """Launch file in XML.

    Args:
        launch_file_path: Path of the file.
    """

    def __init__(self, launch_file_path: SomeSubstitutionsType) -> None:
        super().__init__(launch_file_path, method="interpreted XML launch file")


class YAMLLaunchDescriptionSource(FrontendLaunchDescriptionSource):
    """Launch file in YAML.

    Args:
        launch_file_path: Path of the file.
    """

    def __init__(self, launch_file_path: SomeSubstitutionsType) -> None:
        super().__init__(launch_file_path, method="interpreted YAML launch file")
