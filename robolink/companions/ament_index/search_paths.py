"""Search path of the packages that were installed for ROS 2."""

from __future__ import annotations

from robolink.workspace.installed import prefixes


def get_search_paths() -> list[str]:
    """Return the existing folders in AMENT_PREFIX_PATH, and those of COLCON_PREFIX_PATH; none if neither is set.

    ROS 2 raises an error then; here packages are found without it.
    """
    return prefixes()
