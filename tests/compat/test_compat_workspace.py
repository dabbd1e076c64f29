"""robolink.compat finds the interface types of the workspace in which the importing file lies."""

from __future__ import annotations

import importlib
import subprocess
import sys
from collections.abc import Iterator
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from typing import Any

import pytest

from robolink.workspace import VARIABLE
from robolink.workspace.interfaces import WORKSPACE_TYPES

USES = "from my_levels.msg import Level\nlevel = Level(height=2.0)\n"


@pytest.fixture
def workspace(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A workspace with two packages of types, and a test; the working directory is elsewhere."""
    home = tmp_path / "home"
    for folder in ("nodes", "interfaces/my_levels/msg", "src/depths/msg", "tests"):
        (home / folder).mkdir(parents=True)
    (home / "interfaces/my_levels/msg/Level.msg").write_text("float64 height\n")
    (home / "src/depths/package.xml").write_text("<package><name>depths</name></package>")
    (home / "src/depths/msg/Depth.msg").write_text("float32 value\n")
    (home / "tests/test_levels.py").write_text(USES)
    monkeypatch.delenv(VARIABLE, raising=False)
    monkeypatch.setattr(WORKSPACE_TYPES, "_added", [])
    (tmp_path / "elsewhere").mkdir()
    monkeypatch.chdir(tmp_path / "elsewhere")
    yield home
    for name in [each for each in sys.modules if each.partition(".")[0] in ("my_levels", "depths")]:
        del sys.modules[name]


@pytest.mark.usefixtures("compat")
def test_types_of_the_workspace_of_a_file_are_found(workspace: Path) -> None:
    module: Any = load_file(workspace / "tests/test_levels.py")
    assert module.level.height == 2.0
    (workspace / "tests/test_depths.py").write_text("from depths.msg import Depth")
    assert load_file(workspace / "tests/test_depths.py").Depth().value == 0.0


@pytest.mark.usefixtures("compat")
def test_types_are_found_by_a_name_that_is_a_text(workspace: Path) -> None:
    (workspace / "tests/test_named.py").write_text(
        "import importlib\nlevel = importlib.import_module('my_levels.msg').Level(height=2.0)\n"
    )
    module: Any = load_file(workspace / "tests/test_named.py")
    assert module.level.height == 2.0


@pytest.mark.usefixtures("compat")
def test_types_are_found_where_rosidl_defines_them(workspace: Path) -> None:
    (workspace / "interfaces/my_levels/action").mkdir()
    (workspace / "interfaces/my_levels/action/FillUp.action").write_text("---\n---\nfloat64 height\n")
    (workspace / "tests/test_levels.py").write_text(
        "from my_levels.msg._level import Level\nfrom my_levels.action import _fill_up\n"
        "from my_levels.action._fill_up import FillUp_FeedbackMessage\n"
    )
    module: Any = load_file(workspace / "tests/test_levels.py")
    assert module.Level(height=2.0).height == 2.0
    assert module.FillUp_FeedbackMessage is module._fill_up.FillUp.Impl.FeedbackMessage
    (workspace / "tests/test_none.py").write_text("from my_levels.msg._levle import Level")
    with pytest.raises(ImportError, match="_levle"):
        load_file(workspace / "tests/test_none.py")


@pytest.mark.usefixtures("compat")
def test_types_of_nobody_and_of_other_workspaces_are_not(workspace: Path, tmp_path: Path) -> None:
    (tmp_path / "elsewhere/test_levels.py").write_text(USES)
    with pytest.raises(ImportError, match="No module named 'my_levels'"):
        load_file(tmp_path / "elsewhere/test_levels.py")
    (workspace / "tests/test_none.py").write_text("from my_lvls.msg import Level")
    with pytest.raises(ImportError, match="No module named 'my_lvls'"):
        load_file(workspace / "tests/test_none.py")


@pytest.mark.usefixtures("compat")
def test_an_installed_package_of_the_name_goes_first(workspace: Path) -> None:
    (workspace / "site/my_levels").mkdir(parents=True)
    (workspace / "site/my_levels/__init__.py").touch()
    (workspace / "site/my_levels/msg.py").write_text("def Level(height): return 'installed'")
    sys.path.insert(0, str(workspace / "site"))
    importlib.invalidate_caches()
    assert load_file(workspace / "tests/test_levels.py").level == "installed"


@pytest.mark.processes
def test_a_program_needs_one_line(workspace: Path) -> None:
    (workspace / "tests/test_levels.py").write_text(f"import robolink.compat\n{USES}print(level.height)")
    ran = subprocess.run(
        [sys.executable, workspace / "tests/test_levels.py"], capture_output=True, text=True, check=False
    )
    assert (ran.stdout, ran.stderr) == ("2.0\n", "")


def load_file(path: Path) -> Any:
    """Load a file as a module."""
    spec = spec_from_file_location(path.stem, path)
    assert spec is not None
    assert spec.loader is not None
    module = module_from_spec(spec)
    spec.loader.exec_module(module)
    return module
