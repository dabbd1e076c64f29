"""Packages that were built and installed, as `colcon build` does: those of the prefixes in AMENT_PREFIX_PATH.

COLCON_PREFIX_PATH names the folders `install/`: their packages are there, or each has a folder of its own in them. Only
executables in Python count; what was compiled is nothing that robolink runs.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

from robolink.workspace.setup_files import entry_points_file
from robolink.workspace.source import NodeSource

AMENT, COLCON = "AMENT_PREFIX_PATH", "COLCON_PREFIX_PATH"
"""Environment variables with prefixes, separated as in PATH."""
INDEX = "share/ament_index/resource_index"
"""Folder of the index of a prefix."""


def prefixes() -> list[str]:
    """Return the existing prefixes of packages that were installed, in the order in which they are searched."""
    ament = [each for each in os.environ.get(AMENT, "").split(os.pathsep) if each]
    colcon = [each for each in os.environ.get(COLCON, "").split(os.pathsep) if each]
    isolated = [str(each) for folder in colcon for each in _inside(Path(folder)) if (each / INDEX).is_dir()]
    merged = [each for each in colcon if Path(each, INDEX).is_dir()]
    return [each for each in dict.fromkeys([*ament, *isolated, *merged]) if os.path.exists(each)]  # noqa: PTH110


def installed_packages() -> dict[str, str]:
    """Return the packages that were installed: name to prefix."""
    found: dict[str, str] = {}
    for prefix in prefixes():
        for each in _inside(Path(prefix, INDEX, "packages")):
            if each.is_file() and not each.name.startswith("."):
                found.setdefault(each.name, prefix)
    return found


def installed_executables(package: str) -> dict[str, NodeSource]:
    """Return the executables in Python of the installed `package`, by name; none if it is not installed."""
    prefix = installed_packages().get(package)
    if prefix is None:
        return {}
    from robolink.workspace.cmake_files import is_python  # late: a node's start has no installed packages to look at

    roots = list(_site_packages(Path(prefix)))
    found = {}
    for path in _inside(Path(prefix, "lib", package)):
        if path.is_file() and is_python(path):
            found[path.name] = NodeSource(path.name, path, root=roots[0] if roots else None)
    for root in roots:
        for info in [*root.glob(f"{package}*.egg-info"), *root.glob(f"{package}*.dist-info")]:
            for name, (module, function) in entry_points_file(info / "entry_points.txt").items():
                part = root.joinpath(*module.split("."))
                file = part.with_suffix(".py") if not part.is_dir() else part / "__init__.py"
                if name in found:
                    found[name] = NodeSource(name, file, function, module=module, root=root)
    return found


def _site_packages(prefix: Path) -> Iterator[Path]:
    """Yield the folders of a prefix from which Python imports, and the sources to which `--symlink-install` links."""
    for pattern in ("lib/python3*/site-packages", "local/lib/python3*/dist-packages", "Lib/site-packages"):
        for folder in sorted(prefix.glob(pattern)):
            yield folder
            for link in sorted(folder.glob("*.egg-link")):
                linked = Path(link.read_text(encoding="utf-8", errors="replace").partition("\n")[0].strip())
                if linked.is_dir():
                    yield linked


def _inside(folder: Path) -> list[Path]:
    try:
        return sorted(folder.iterdir())
    except OSError:
        return []
