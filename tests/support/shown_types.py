"""Types of a workspace for tests of robolink interface."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from robolink.cli.main import main

Workspace = Callable[[str, str], None]

INNER = """\
# A short type

# A constant
bool BOOL_CONST=true  # is true

# Fields
bool flag true
string<=5 label "a # b"  # the label
bool[<=3] flags  # three at most
"""

OUTER = """\
# A type with another in it

Inner inner  # Comment - 1 of 1
float64[2] pair [0.5, 1.5]
# The end
"""

ASK = "# Request\nInner inner  # asked\n---\n# Response\nbool done  # answered\n"

DO = "# Goal\nOuter outer\n---\nint32 code\n---\nfloat32 progress  # 0 to 1\n"


def shown(capsys: pytest.CaptureFixture[str], *args: str) -> str:
    assert main(["interface", *args]) == 0
    return capsys.readouterr().out


def refused(capsys: pytest.CaptureFixture[str], *args: str, code: int = 1) -> str:
    assert main(["interface", *args]) == code
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.count("\n") == 1
    return captured.err.strip()
