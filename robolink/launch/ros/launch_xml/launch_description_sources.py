"""Launch files in XML, as sources of launch descriptions."""

from __future__ import annotations

from robolink.launch.ros.launch.bases import SomeSubstitutionsType
from robolink.launch.ros.launch.sources import FrontendLaunchDescriptionSource

__all__ = [
    "XMLLaunchDescriptionSource",
]


class XMLLaunchDescriptionSource(FrontendLaunchDescriptionSource):
    """Launch file in XML.

    Args:
        launch_file_path: Path of the file.
    """

    def __init__(self, launch_file_path: SomeSubstitutionsType) -> None:
        super().__init__(launch_file_path, method="interpreted XML launch file")
