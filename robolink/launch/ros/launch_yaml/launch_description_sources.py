"""Launch files in YAML, as sources of launch descriptions."""

from __future__ import annotations

from robolink.launch.ros.launch.bases import SomeSubstitutionsType
from robolink.launch.ros.launch.sources import FrontendLaunchDescriptionSource

__all__ = [
    "YAMLLaunchDescriptionSource",
]


class YAMLLaunchDescriptionSource(FrontendLaunchDescriptionSource):
    """Launch file in YAML.

    Args:
        launch_file_path: Path of the file.
    """

    def __init__(self, launch_file_path: SomeSubstitutionsType) -> None:
        super().__init__(launch_file_path, method="interpreted YAML launch file")
