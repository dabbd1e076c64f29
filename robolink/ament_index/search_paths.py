"""The folders into which packages of ROS 2 were installed."""

from __future__ import annotations

import os

from robolink.ament_index.constants import AMENT_PREFIX_PATH_ENV_VAR


def get_search_paths() -> list[str]:
    """Give the folders that AMENT_PREFIX_PATH names and that exist; none where it is not set.

    ROS 2 raises an error then; here packages are found without it.
    """
    named = os.environ.get(AMENT_PREFIX_PATH_ENV_VAR, "").split(os.pathsep)
    return [each for each in named if each and os.path.exists(each)]  # noqa: PTH110 - any spelling stays as it is
