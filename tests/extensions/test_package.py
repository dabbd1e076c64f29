"""The package that the manual shows adds a verb, a sensor and a message once it is installed from its own wheel."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.support.commands import ROBOLINK, Command
from tests.support.domains import free_domain
from tools.docs_site.markdown import blocks

PAGE = Path(__file__).parents[2] / "docs/reference/extensions.md"
MOST_LINES = 30


def run(*words: str, folder: Path, environ: dict[str, str]) -> str:
    found = subprocess.run(
        words, cwd=folder, env={**os.environ, **environ}, capture_output=True, text=True, check=False
    )
    assert found.returncode == 0, found.stderr + found.stdout
    return found.stdout


@pytest.fixture
def installed(tmp_path: Path) -> Path:
    """A folder with the page's files, and in `site` what pip installs of their wheel, without a network."""
    pytest.importorskip("hatchling", reason="the wheel is built with hatchling, which is not installed here")
    for block in blocks(PAGE.read_text(encoding="utf-8")):
        if block.title:
            (tmp_path / block.title).parent.mkdir(parents=True, exist_ok=True)
            (tmp_path / block.title).write_text(block.text, encoding="utf-8")
    pip = (sys.executable, "-m", "pip", "--disable-pip-version-check")
    offline = ("--no-index", "--no-deps")
    run(
        *pip, "wheel", *offline, "--no-build-isolation", "-w", "dist", "./robolink-compass", folder=tmp_path, environ={}
    )
    (wheel,) = (tmp_path / "dist").iterdir()
    run(*pip, "install", *offline, "--target", "site", str(wheel), folder=tmp_path, environ={})
    return tmp_path


@pytest.mark.processes
@pytest.mark.slow
def test_the_package_of_the_manual_works_from_its_wheel(installed: Path) -> None:
    code = (installed / "robolink-compass/robolink_compass/__init__.py").read_text(encoding="utf-8")
    assert len([line for line in code.splitlines() if line]) <= MOST_LINES
    with free_domain() as domain:
        environ = {"PYTHONPATH": str(installed / "site"), "ROS_DOMAIN_ID": str(domain)}
        assert "Show where a robot looks." in run(*ROBOLINK, "topic", "--help", folder=installed, environ=environ)
        run(sys.executable, "-m", "pytest", "-q", "robolink-compass", folder=installed, environ=environ)
        program = "import robolink.compat\nfrom compass_msgs.msg import Heading\nprint(Heading(degrees=2.0).degrees)"
        assert run(sys.executable, "-c", program, folder=installed, environ=environ) == "2.0\n"
        with Command(domain, "run", "world", "-p", "world:=compass.yaml", folder=installed, environ=environ):
            echoed = run(*ROBOLINK, "topic", "echo", "/heading", "--once", folder=installed, environ=environ)
            assert "degrees: 28.64" in echoed
            assert run(*ROBOLINK, "topic", "heading", folder=installed, environ=environ) == "28.6 degrees\n"
