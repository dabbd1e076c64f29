"""Late imports: this machine's own network does without these modules, which would delay every command."""

from __future__ import annotations

import subprocess
import sys

import pytest

CODE = """
import sys
from robolink.transport import network
network.load("localhost", 0, {})
rooms = ("places", "hosts", "named", "port_probe")
late = [f"robolink.networks.{each}" for each in rooms]
print(*[each for each in (*late, "yaml", "socket") if each in sys.modules])
"""


@pytest.mark.processes
def test_localhost_imports_nothing_of_the_other_networks() -> None:
    done = subprocess.run([sys.executable, "-c", CODE], capture_output=True, text=True, check=True)
    assert done.stdout == "\n"
