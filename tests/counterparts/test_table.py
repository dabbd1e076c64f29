"""Every row of the table of counterparts leads to code that can be run."""

from __future__ import annotations

import pytest

from robolink.workspace import COUNTERPARTS, canonical, find_executable, load_node

ROWS = [(package, name) for package, rows in COUNTERPARTS.items() for name in rows]


@pytest.mark.parametrize(("package", "name"), ROWS)
def test_every_row_can_be_run(package: str, name: str) -> None:
    source = find_executable(package, name)
    assert callable(load_node(source))
    purpose = COUNTERPARTS[package][name].purpose
    assert purpose.endswith(".")
    assert (purpose[0].isupper(), "\n" in purpose, len(purpose) <= 90) == (True, False, True)
    assert (package, name) == (canonical(package), canonical(name).removesuffix(".py"))
