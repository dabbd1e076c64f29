"""Packages that `colcon build` has installed are found in the prefixes that a terminal has sourced."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from robolink.companions.ament_index import get_package_prefix, get_package_share_directory
from robolink.exceptions import NotFoundError
from robolink.workspace import find_executable, installed, load_node
from robolink.workspace.installed import installed_executables, installed_packages, prefixes

WRAPPER = "#!/usr/bin/python3\nfrom importlib.metadata import distribution\nraise SystemExit('never run')\n"


def install(prefix: Path, name: str, *, site: str = "lib/python3.12/site-packages") -> None:
    """Installed files of a package, as of colcon: its mark, two programs, and the module of one of them."""
    for folder in (installed.INDEX + "/packages", f"lib/{name}", f"share/{name}", f"{site}/{name}"):
        (prefix / folder).mkdir(parents=True, exist_ok=True)
    (prefix / installed.INDEX / "packages" / name).touch()
    (prefix / "lib" / name / "talk").write_text(WRAPPER)
    (prefix / "lib" / name / "hear.py").write_text(f"from {name}.words import WORD\ndef main(): return WORD\n")
    (prefix / "lib" / name / "compiled").write_bytes(b"\x7fELF\n")
    (prefix / site / name / "__init__.py").touch()
    (prefix / site / name / "words.py").write_text(f"WORD = '{name}'\ndef main(): return WORD\n")
    info = prefix / site / f"{name}-0.0.0-py3.12.egg-info"
    info.mkdir()
    (info / "entry_points.txt").write_text(f"[console_scripts]\ntalk = {name}.words:main\nother = {name}.words:main\n")


@pytest.fixture
def ws(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Two packages with a prefix each, and one in a merged prefix."""
    install(tmp_path / "install/pkg_one", "pkg_one")
    install(tmp_path / "install/pkg_two", "pkg_two")
    install(tmp_path / "merged", "pkg_three", site="local/lib/python3.10/dist-packages")
    monkeypatch.setenv("AMENT_PREFIX_PATH", f"{tmp_path / 'install/pkg_one'}:{tmp_path / 'gone'}")
    monkeypatch.setenv("COLCON_PREFIX_PATH", f"{tmp_path / 'install'}:{tmp_path / 'merged'}")
    monkeypatch.chdir(tmp_path)
    monkeypatch.syspath_prepend(str(tmp_path / "nothing"))  # restores sys.path at the end
    return tmp_path


def test_prefixes_of_both_variables(ws: Path) -> None:
    assert prefixes() == [str(ws / each) for each in ("install/pkg_one", "install/pkg_two", "merged")]
    assert list(installed_packages()) == ["pkg_one", "pkg_two", "pkg_three"]
    assert get_package_prefix("pkg_three") == str(ws / "merged")
    assert get_package_share_directory("pkg_two") == str(ws / "install/pkg_two/share/pkg_two")


@pytest.mark.usefixtures("ws")
@pytest.mark.parametrize("package", ["pkg_one", "pkg_two", "pkg_three"])
def test_what_is_python_runs(package: str) -> None:
    assert sorted(installed_executables(package)) == ["hear.py", "talk"]
    for name in ("talk", "hear.py", "hear"):
        run: Any = load_node(find_executable(package, name))
        assert run() == package
    with pytest.raises(NotFoundError, match="no executable named 'compiled' in package"):
        find_executable(package, "compiled")


def test_what_is_linked_to_its_sources_runs(ws: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    site = ws / "install/pkg_four/lib/python3.12/site-packages"
    build = ws / "build/pkg_four"
    install(ws / "install/pkg_four", "pkg_four")
    build.parent.mkdir()
    site.rename(build)
    site.mkdir()
    (site / "pkg-four.egg-link").write_text(f"{build}\n.")
    assert installed_executables("pkg_four")["talk"].path == build / "pkg_four/words.py"


@pytest.mark.usefixtures("ws")
def test_a_package_that_is_not_installed_has_none() -> None:
    assert installed_executables("pkg_five") == {}
