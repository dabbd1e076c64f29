"""Index of packages and their folders: the API of ROS 2's ament_index_python.

A package is what `robolink run PACKAGE EXECUTABLE` takes for one (see `robolink.workspace.packages`): a folder below
the `src/` of the workspace, the workspace itself by its folder's name, `robolink`. Nothing is built or installed, so
the **share directory of a package is its own folder**: `launch/`, `config/` and `urdf/` lie there as they would after
`setup.py` has copied them to share/PACKAGE. Where it gives them other names or places, it is a folder of links that has
both (see `robolink.workspace.share`). A package that has only types, such as geometry_msgs, has the folder of its
module. After these, the folders of AMENT_PREFIX_PATH are searched, as in ROS 2.
"""

from robolink.companions.ament_index.constants import RESOURCE_INDEX_SUBFOLDER
from robolink.companions.ament_index.packages import (
    PackageNotFoundError,
    get_package_prefix,
    get_package_share_directory,
    get_package_share_path,
    get_packages_with_prefixes,
)
from robolink.companions.ament_index.resources import (
    InvalidResourceNameError,
    InvalidResourceTypeNameError,
    get_resource,
    get_resource_types,
    get_resources,
    has_resource,
)
from robolink.companions.ament_index.search_paths import get_search_paths

__all__ = [
    "RESOURCE_INDEX_SUBFOLDER",
    "InvalidResourceNameError",
    "InvalidResourceTypeNameError",
    "PackageNotFoundError",
    "get_package_prefix",
    "get_package_share_directory",
    "get_package_share_path",
    "get_packages_with_prefixes",
    "get_resource",
    "get_resource_types",
    "get_resources",
    "get_search_paths",
    "has_resource",
]
