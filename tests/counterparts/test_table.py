"""Every program that robolink has of ROS packages leads to code that can be run."""

from __future__ import annotations

import pytest

from robolink.workspace import canonical, find_executable, load_node, program_names

ROWS = [(package, name) for package, names in program_names().items() for name in names]


@pytest.mark.parametrize(("package", "name"), ROWS)
def test_every_row_can_be_run(package: str, name: str) -> None:
    assert callable(load_node(find_executable(package, name)))
    assert (package, name) == (canonical(package), canonical(name).removesuffix(".py"))
