"""Substitutions about packages (`launch_ros.substitutions`)."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from robolink.companions.ament_index import get_package_prefix, get_package_share_directory
from robolink.exceptions import NotFoundError, RobolinkError
from robolink.launch.ros.launch.bases import LaunchContext, SomeSubstitutionsType, Substitution
from robolink.launch.ros.launch.substitutions import PathJoinSubstitution, SubstitutionFailure
from robolink.launch.ros.launch.utilities import is_substitution, normalize_to_list_of_substitutions, performed
from robolink.workspace.packages import executable, executables

__all__ = [
    "ExecutableInPackage",
    "FindPackage",
    "FindPackagePrefix",
    "FindPackageShare",
    "Parameter",
]


class _FindPackage(Substitution):
    """Substitution by a folder of a package.

    Args:
        package: Name of the package.
    """

    def __init__(self, package: SomeSubstitutionsType) -> None:
        self.package = normalize_to_list_of_substitutions(package)

    def find(self, package_name: str) -> str:
        """Return the folder of the package `package_name`."""
        raise NotImplementedError

    def perform(self, context: LaunchContext) -> str:
        """Return the folder; raises SubstitutionFailure if there is no such package."""
        try:
            return self.find(performed(context, self.package))
        except RobolinkError as error:
            raise SubstitutionFailure(str(error)) from None

    def __truediv__(self, part: SomeSubstitutionsType) -> PathJoinSubstitution:
        """Return the path with one more `part`."""
        return PathJoinSubstitution([self, part])


class FindPackagePrefix(_FindPackage):
    """Folder into which a package is installed; its own folder if it was never built."""

    def find(self, package_name: str) -> str:
        """Return the folder of the package `package_name`."""
        return get_package_prefix(package_name)


FindPackage = FindPackagePrefix


class FindPackageShare(_FindPackage):
    """Folder of a package's files, such as `launch` and `config`."""

    def find(self, package_name: str) -> str:
        """Return the folder of the package `package_name`."""
        return get_package_share_directory(package_name)


class ExecutableInPackage(Substitution):
    """Path of an executable of a package.

    Args:
        executable: Name of the executable.
        package: Name of the package.
    """

    def __init__(self, executable: SomeSubstitutionsType, package: SomeSubstitutionsType) -> None:
        self.executable = normalize_to_list_of_substitutions(executable)
        self.package = normalize_to_list_of_substitutions(package)

    def perform(self, context: LaunchContext) -> str:
        """Return the path; raises SubstitutionFailure if there is none."""
        package, name = performed(context, self.package), performed(context, self.executable)
        try:
            folder = Path(get_package_prefix(package))
        except RobolinkError as error:
            raise SubstitutionFailure(str(error)) from None
        installed = folder / "lib" / package / name
        source = executable(folder, name)
        if source is None and not installed.is_file():
            missing = NotFoundError("executable", name, executables(folder), f"package {package}")
            raise SubstitutionFailure(str(missing))
        return str(installed if source is None else source.path)


class Parameter(Substitution):
    """Value of a parameter that SetParameter has set; the first one counts, as in ROS 2.

    Args:
        name: Name of the parameter.
        default: Value where it is not set; without one that is an error.
    """

    def __init__(self, name: SomeSubstitutionsType, *, default: Any = None) -> None:
        self.name, self.default = normalize_to_list_of_substitutions(name), default

    def perform(self, context: LaunchContext) -> str:
        """Return the value; raises SubstitutionFailure if it is not set."""
        name = performed(context, self.name)
        given = context.launch_configurations.get("global_params", [])
        found = next((each[1] for each in given if isinstance(each, tuple) and each[0] == name), self.default)
        if found is None:
            raise SubstitutionFailure(f"no SetParameter has set '{name}'")
        return performed(context, found) if is_substitution(found) else str(found)
