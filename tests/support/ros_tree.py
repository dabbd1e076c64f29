"""Writer of ROS 2 source trees as `ros2 pkg create` makes them, for tests."""

from __future__ import annotations

from pathlib import Path

SETUP = """\
from setuptools import find_packages, setup

package_name = {name!r}

setup(
    name=package_name,
    version='0.0.0',
    packages=find_packages(exclude=['test']),
    data_files=[('share/ament_index/resource_index/packages', ['resource/' + package_name])],
    install_requires=['setuptools'],
    zip_safe=True,
    entry_points={{
        'console_scripts': [
{scripts}
        ],
    }},
)
"""


def write_package(src: Path, name: str, files: dict[str, str], *scripts: str) -> Path:
    """Write a Python package with these modules and console scripts; its folder."""
    folder = src / name
    listed = "\n".join(f"            '{each}'," for each in scripts)
    texts = {
        "package.xml": f'<?xml version="1.0"?>\n<package format="3">\n  <name>{name}</name>\n</package>\n',
        "setup.py": SETUP.format(name=name, scripts=listed),
        f"resource/{name}": "",
        f"{name}/__init__.py": "",
        **{f"{name}/{file}": text for file, text in files.items()},
    }
    for file, text in texts.items():
        path = folder / file
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
    return folder
