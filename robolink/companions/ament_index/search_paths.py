"""Search path of the packages that were installed for ROS 2."""

from __future__ import annotations

import os

from robolink.companions.ament_index.constants import AMENT_PREFIX_PATH_ENV_VAR


def get_search_paths() -> list[str]:
    """Return the existing folders in AMENT_PREFIX_PATH; none if it is not set.

    ROS 2 raises an error then; here packages are found without it.
    """
    named = os.environ.get(AMENT_PREFIX_PATH_ENV_VAR, "").split(os.pathsep)
    return [each for each in named if each and os.path.exists(each)]  # noqa: PTH110 - any spelling stays as it is
