"""Writer of new ROS 2 packages, as `ros2 pkg create` makes them: they run here as they are, and colcon builds them."""

from __future__ import annotations

import re
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from xml.sax.saxutils import escape

from robolink.scaffold.writing import (
    TEMPLATES,
    Made,
    ScaffoldError,
    checked,
    checked_module,
    class_name,
    rendered,
    written,
)

PYTHON, CMAKE = ("ament_python", "ament_cmake")
"""Build types of packages that can be made."""
_DEPENDENCY = re.compile(r"[A-Za-z0-9][A-Za-z0-9_+.-]*")
_UNFIT = re.compile("[^\\t\\n\\x20-\\x7e\\xa0-\\ud7ff\\ue000-\\ufffd\\U00010000-\\U0010ffff]")
"""Control characters other than tab and newline, and what XML forbids."""
_LIBRARY = """
add_library(@LIBRARY@ src/@LIBRARY@.cpp)
target_include_directories(@LIBRARY@ PUBLIC
  $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include>
  $<INSTALL_INTERFACE:include/${PROJECT_NAME}>)
install(DIRECTORY include/ DESTINATION include/${PROJECT_NAME})
install(TARGETS @LIBRARY@ ARCHIVE DESTINATION lib LIBRARY DESTINATION lib RUNTIME DESTINATION bin)
"""


@dataclass(frozen=True)
class NewPackage:
    """Description of a new package for `new_package`; `node` and `library` are names, '' for none."""

    name: str
    build_type: str = CMAKE
    package_format: int = 3
    description: str = "TODO: Package description"
    license: str = "TODO: License declaration"
    maintainer: str = "user"
    email: str = "user@todo.todo"
    dependencies: Sequence[str] = ()
    node: str = ""
    library: str = ""


def new_package(package: NewPackage, destination: Path) -> Made:
    """Make a `package` in a folder of its name below `destination`.

    A node is a Python program in both build types, since robolink runs no C++.

    Raises:
        ScaffoldError: (a ValueError) if a name is not valid or, in Python, taken; if a text has a control character; if
            the folder is there already.
        OSError: if the files cannot be written.
    """
    _check(package)
    if (destination / package.name).exists():
        raise ScaffoldError(
            f"{destination / package.name} is there already: take another name or --destination-directory"
        )
    files = _python(package) if package.build_type == PYTHON else _cmake(package)
    files.update(license_files(package.license, package.maintainer))
    return written(destination / package.name, package.name, files)


def _check(package: NewPackage) -> None:
    """Raise ScaffoldError if a name or a text is not fit for the files of a package."""
    names = {"package": package.name, "node": package.node, "library": package.library}
    for kind, name in names.items():
        fit = checked_module if kind == "package" and package.build_type == PYTHON else checked
        if (name or kind == "package") and not fit(kind, name).isidentifier():
            raise ScaffoldError(f"'{name}' is not a name for a {kind}: Python imports no '-', take '_'")
    for each in package.dependencies:
        if not _DEPENDENCY.fullmatch(each):
            raise ScaffoldError(f"'{each[:60]}' is not a name of a package to depend on")
    if package.node and package.node == package.library:
        raise ScaffoldError(f"the node and the library cannot both be called '{package.node}'")
    _check_texts(package)


def _check_texts(package: NewPackage) -> None:
    texts = {
        "description": package.description,
        "license": package.license,
        "maintainer's name": package.maintainer,
        "maintainer's email": package.email,
    }
    for what, text in texts.items():
        unfit = _UNFIT.search(text)
        if unfit is not None:
            raise ScaffoldError(
                f"the {what} has the character {unfit[0]!a}, which package.xml cannot hold: leave it out"
            )


def _python(package: NewPackage) -> dict[str, str]:
    name, node, library = package.name, package.node, package.library
    script = f"\n            '{node} = {name}.{node}:main'," if node else ""
    added = {f"{name}/{node}.py": _node(name)} if node else {}
    if library:
        added[f"{name}/{library}/__init__.py"] = ""
    return {**rendered("package_python", {**_words(package), "SCRIPTS": script}), **added}


def _cmake(package: NewPackage) -> dict[str, str]:
    node, library = package.node, package.library
    find = "".join(f"find_package({each} REQUIRED)\n" for each in package.dependencies)
    install = _LIBRARY.replace("@LIBRARY@", library) if library else ""
    added = {}
    if library:
        guard = f"{package.name}__{library}_HPP_".upper()
        words = {"NAME": package.name, "LIBRARY": library, "CLASS": class_name(library), "GUARD": guard}
        added = rendered("package_library", words)
    if node:
        install += f"\ninstall(PROGRAMS scripts/{node}.py DESTINATION lib/${{PROJECT_NAME}} RENAME {node})\n"
        added[f"scripts/{node}.py"] = "#!/usr/bin/env python3\n\n\n" + _node(package.name)
    words = {**_words(package), "FIND": find, "INSTALL": install}
    return {**rendered("package_cmake", words), **added}


def _node(package: str) -> str:
    return f"def main():\n    print('Hi from {package}.')\n\n\nif __name__ == '__main__':\n    main()\n"


def _words(package: NewPackage) -> dict[str, str]:
    dependencies = "".join(f"  <depend>{escape(each)}</depend>\n" for each in package.dependencies)
    texts = {
        "MAINTAINER": package.maintainer,
        "DESCRIPTION": package.description,
        "LICENSE": package.license,
    }
    return {
        **{f"PY_{key}": repr(text) for key, text in {**texts, "EMAIL": package.email}.items()},
        "FORMAT": str(package.package_format),
        "NAME": package.name,
        "EMAIL": escape(package.email, {'"': "&quot;"}),
        **{key: escape(text) for key, text in texts.items()},
        "DEPENDENCIES": f"\n{dependencies}" if dependencies else "",
    }


FOLDER = "licenses"
"""Folder of the texts, one for each identifier."""


def known_licenses() -> list[str]:
    """Return the identifiers of the licences whose text is here, such as MIT."""
    return sorted(each.stem for each in (TEMPLATES / FOLDER).iterdir())


def license_files(identifier: str, holder: str) -> dict[str, str]:
    """Return the file LICENSE of a package by its path; nothing for a licence whose text is not here.

    Args:
        identifier: The licence, as package.xml names it.
        holder: Name of who has the copyright.
    """
    if identifier not in known_licenses():
        return {}
    texts = rendered(FOLDER, {"YEAR": str(time.localtime().tm_year), "HOLDER": holder})
    return {"LICENSE": texts[identifier]}
