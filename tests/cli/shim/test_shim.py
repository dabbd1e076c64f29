"""robolink shim: commands ros2 and colcon lead to robolink, and no command of others is touched."""

from __future__ import annotations

import io
import os
import shlex
import subprocess
import sys
import zipfile
from pathlib import Path
from xml.etree import ElementTree

import pytest

from robolink.cli.main import main
from robolink.cli.running_nodes import runner
from robolink.cli.shim import colcon, launch_test, writing
from robolink.workspace import find_package
from tests.support.ros_tree import write_package

Captured = pytest.CaptureFixture[str]
SUFFIX = ".exe" if sys.platform == "win32" else ""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder of commands, which alone is on the PATH."""
    (tmp_path / "it's bin").mkdir()
    monkeypatch.setenv("PATH", str(tmp_path / "it's bin"))
    return tmp_path / "it's bin"


def shim(*words: str, folder: Path) -> int:
    return main(["shim", *words, "--folder", str(folder)])


@pytest.mark.processes
def test_the_command_is_robolink_by_another_name(folder: Path, capsys: Captured) -> None:
    assert shim("ros2", folder=folder) == 0
    path = folder / f"ros2{SUFFIX}"
    advice = f"robolink shim ros2 --remove --folder {shlex.quote(str(folder))}"
    assert capsys.readouterr().out == f"made {path}; '{advice}' takes it away\n"
    environ = {**os.environ, "PATH": f"/bin:/usr/bin:{folder}"}
    asked = subprocess.run([path, "daemon", "status"], capture_output=True, text=True, env=environ, check=False)
    assert (asked.returncode, asked.stdout[:29]) == (0, "The daemon is not running: ro")
    wrong = subprocess.run([path, "tpic"], capture_output=True, text=True, env=environ, check=False)
    assert (wrong.returncode, "did you mean 'topic'?" in wrong.stderr) == (2, True)


def test_it_is_written_again_and_taken_away(folder: Path, capsys: Captured) -> None:
    assert [shim("ros2", folder=folder), shim("ros2", folder=folder), shim("ros2", "--remove", folder=folder)] == [
        0
    ] * 3
    assert list(folder.iterdir()) == []
    capsys.readouterr()
    assert shim("ros2", "--remove", folder=folder) == 1
    assert capsys.readouterr().err == f"robolink: {folder / f'ros2{SUFFIX}'} is not there\n"


@pytest.mark.parametrize("place", ["there", "elsewhere"])
def test_a_real_one_is_left_alone_unless_that_is_asked_for(
    place: str, folder: Path, tmp_path: Path, capsys: Captured, monkeypatch: pytest.MonkeyPatch
) -> None:
    real = (folder if place == "there" else tmp_path) / f"ros2{SUFFIX}"
    real.write_text("#!/bin/sh\n")
    real.chmod(0o755)
    monkeypatch.setenv("PATH", f"{folder}{os.pathsep}{tmp_path}")
    assert shim("ros2", folder=folder) == 1
    verb = "replace" if place == "there" else "hide"
    assert f"{real} is a real ros2, which this one would {verb}; --force" in capsys.readouterr().err
    if place == "there":
        assert shim("ros2", "--remove", folder=folder) == 1
        assert "was not made by 'robolink shim': it stays" in capsys.readouterr().err
    assert real.read_text() == "#!/bin/sh\n"
    assert shim("ros2", "--force", folder=folder) == 0
    assert b"robolink" in (folder / f"ros2{SUFFIX}").read_bytes()


def test_what_cannot_be_written_is_one_line(tmp_path: Path, capsys: Captured) -> None:
    assert shim("colcon", folder=tmp_path / "gone") == 1
    assert shim("rosdep", folder=tmp_path) == 2
    first, second = capsys.readouterr().err.splitlines()
    assert "cannot be written: No such file" in first
    assert "'rosdep' is none of ros2, colcon" in second


# --- Windows ----------------------------------------------------------------------------------------------------------

MAIN = """import re
import sys
from robolink.cli.main import main
if __name__ == '__main__':
    sys.argv[0] = re.sub(r'(-script\\.pyw|\\.exe)?$', '', sys.argv[0])
    sys.exit(main())
"""
"""The program in a launcher of pip's."""


def launcher(path: Path, program: str) -> None:
    """Write a launcher as pip does: a program of Windows, the Python to start, and an archive with what that runs."""
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w") as archive:
        archive.writestr("__main__.py", program)
    path.write_bytes(b"MZ" + bytes(1000) + f'#!"{sys.executable}"\r\n'.encode() + content.getvalue())


@pytest.fixture
def windows(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A home with an accent, whose folder of commands has robolink's launcher."""
    scripts = tmp_path / "José" / "Scripts"
    scripts.mkdir(parents=True)
    launcher(scripts / "robolink.exe", MAIN)
    monkeypatch.setattr(sys, "platform", "win32")
    monkeypatch.setattr(sys, "argv", [str(scripts / "robolink"), "shim"])
    monkeypatch.setenv("PATH", str(scripts))
    return scripts


@pytest.mark.processes
def test_on_windows_a_command_is_a_copy_of_robolinks_launcher(windows: Path, capsys: Captured) -> None:
    """So it starts from a home with accents, ends at Ctrl-C as robolink does, and Git Bash finds it."""
    (windows / "ros2.cmd").write_text(f"@rem {writing.MARK} ros2'")
    for name in ("ros2", "colcon", "launch_test"):
        assert shim(name, folder=windows) == 0
        assert (windows / f"{name}.exe").read_bytes() == (windows / "robolink.exe").read_bytes()
    assert not (windows / "ros2.cmd").exists()
    capsys.readouterr()

    def run(name: str, *words: str) -> tuple[int, str]:
        command = [sys.executable, str(windows / f"{name}.exe"), *words]  # what the launcher does
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        return done.returncode, (done.stdout + done.stderr).strip()

    code, said = run("ros2", "tpic")
    assert (code, "did you mean 'topic'?" in said) == (2, True)
    assert run("colcon", "graph")[1].startswith("robolink: colcon graph is not here")
    assert run("launch_test")[1].startswith("launch_test FILE")
    assert shim("ros2", "--remove", folder=windows) == 0
    assert not (windows / "ros2.exe").exists()


def test_a_launcher_of_others_stays(windows: Path, capsys: Captured, monkeypatch: pytest.MonkeyPatch) -> None:
    launcher(windows / "ros2.exe", "from ros2cli.cli import main")
    real = (windows / "ros2.exe").read_bytes()
    assert shim("ros2", folder=windows) == 1
    assert "is a real ros2, which this one would replace" in capsys.readouterr().err
    assert shim("ros2", "--remove", folder=windows) == 1
    assert (windows / "ros2.exe").read_bytes() == real
    (windows / "robolink.exe").unlink()
    monkeypatch.setattr(writing, "scripts_folder", lambda: windows)
    monkeypatch.setattr("shutil.which", lambda _: None)  # from 3.12 on it asks Windows itself
    assert shim("colcon", folder=windows) == 1
    assert "nor on the PATH: pip makes it" in capsys.readouterr().err


def test_windows_has_one_folder_by_many_spellings(windows: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", os.pathsep.join(["/other", f'"{str(windows).upper()}/"']))
    assert writing.is_on_path(windows)
    assert not writing.is_on_path(windows / "x")


# --- colcon -----------------------------------------------------------------------------------------------------------


@pytest.fixture
def ws(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    write_package(tmp_path / "src", "pkg_one", {"a.py": ""})
    (tmp_path / "src/pkg_two").mkdir()
    (tmp_path / "src/pkg_two/package.xml").write_text("<package><name>pkg_two</name></package>")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_a_build_finds_what_there_is_and_can_be_sourced(ws: Path, capsys: Captured) -> None:
    for words in ([], ["--symlink-install", "--packages-select", "pkg_one", "pkg_two", "--event-handlers", "x"]):
        assert colcon.main(["build", *words]) == 0
        assert capsys.readouterr().out.startswith("2 packages found, nothing has to be built")
    assert (ws / "install/COLCON_IGNORE").is_file()
    assert (ws / "install/setup.bash").read_text().startswith("# Made by")
    assert colcon.main(["build", "--packages-select", "pkg_oen"]) == 1
    assert "no package named 'pkg_oen'" in capsys.readouterr().err


def test_what_was_really_built_stays(ws: Path) -> None:
    (ws / "install").mkdir()
    (ws / "install/pkg_one").touch()
    assert colcon.main(["build"]) == 0
    assert [each.name for each in (ws / "install").iterdir()] == ["pkg_one"]


@pytest.mark.usefixtures("ws")
def test_the_other_verbs(capsys: Captured) -> None:
    assert [colcon.main([each]) for each in ("list", "test", "--help")] == [0, 0, 0]
    assert colcon.main([]) == 0
    out = capsys.readouterr().out
    assert f"pkg_one\t{Path('src/pkg_one')}\t(ros.ament_python)\npkg_two\t" in out
    assert colcon.main(["graph"]) == 2
    assert capsys.readouterr().err == "robolink: colcon graph is not here: colcon build | colcon list | colcon test\n"


TESTED = """
import sys, unittest
import launch, launch_testing, launch_testing.actions
from launch.actions import DeclareLaunchArgument, ExecuteProcess
from launch.substitutions import LaunchConfiguration

def generate_test_description():
    process = ExecuteProcess(cmd=[sys.executable, "-c", "import sys; print(sys.argv[1])", LaunchConfiguration("speed")])
    declared = DeclareLaunchArgument("speed", default_value="1", description="how fast")
    actions = [declared, process, launch_testing.util.KeepAliveProc(), launch_testing.actions.ReadyToTest()]
    return launch.LaunchDescription(actions), {"process": process}

class TestIt(unittest.TestCase):
    def test_speed(self, proc_info, proc_output, process):
        proc_output.assertWaitFor("2", process, stream="stdout")
        proc_info.assertWaitForShutdown(process)

@launch_testing.post_shutdown_test()
class TestAfterwards(unittest.TestCase):
    def test_codes(self, proc_info, process, test_args):
        launch_testing.asserts.assertExitCodes(proc_info, process=process)
        self.assertEqual(test_args, {"speed": "2"})
"""


@pytest.mark.processes
def test_launch_test_runs_the_tests_of_a_file(tmp_path: Path) -> None:
    (tmp_path / "a.py").write_text(TESTED)

    def run(*words: str) -> subprocess.CompletedProcess[str]:
        command = [sys.executable, "-m", "robolink.cli.shim.launch_test", "a.py", *words]
        return subprocess.run(command, capture_output=True, text=True, check=False, cwd=tmp_path)

    done = run("speed:=2", "--junit-xml", "a.xml", "--package-name", "bot")
    assert (done.returncode, done.stderr.count("... ok")) == (0, 2), done.stderr
    report = ElementTree.parse(tmp_path / "a.xml").getroot()
    assert [each.get("classname") for each in report.iter("testcase")] == ["bot.TestIt", "bot.TestAfterwards"]
    assert (report[0].get("name"), report.get("tests"), report.get("failures")) == ("bot.a.launch_tests", "2", "0")
    shown = run("--show-args")
    assert (shown.returncode, "'speed':\n        how fast\n" in shown.stdout) == (0, True)
    assert run("speed").stderr == "robolink: malformed launch argument 'speed': expected NAME:=VALUE\n"


def test_launch_test_tells_what_it_takes(tmp_path: Path, capsys: Captured) -> None:
    assert launch_test.main([]) == 0
    assert capsys.readouterr().out.startswith("launch_test FILE [NAME:=VALUE]...")
    assert launch_test.main(["gone.py"]) == 2
    assert capsys.readouterr().err.startswith("robolink: there is no file among 'gone.py': launch_test FILE")


def test_a_sourced_workspace_is_known_in_every_folder(
    ws: Path, tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch, capsys: Captured
) -> None:
    assert colcon.main(["build"]) == 0
    setup = (ws / "install/setup.bash").read_text(encoding="utf-8")
    assert f"export COLCON_PREFIX_PATH={ws / 'install'}${{COLCON_PREFIX_PATH:+:" in setup
    monkeypatch.chdir(tmp_path_factory.mktemp("elsewhere"))
    assert find_package("pkg_one") is None
    monkeypatch.setenv("COLCON_PREFIX_PATH", os.pathsep.join([str(ws / "install"), "/opt/ros/underlay"]))
    assert find_package("pkg_one") == ws / "src/pkg_one"
    capsys.readouterr()
    runner.found(runner.NodeCommand("pkg_one", ["a"], 1), None)
    said = "setup.py does not name 'a', so ROS 2 will not find it: add 'a = pkg_one.a:main' to its console_scripts"
    assert capsys.readouterr().err == f"robolink: {said}\n"
    write_package(Path("src"), "pkg_mine", {"b.py": ""}, "b = pkg_mine.b:main")
    assert (find_package("pkg_one"), find_package("pkg_mine")) == (None, Path("src/pkg_mine").resolve())
    runner.found(runner.NodeCommand("pkg_mine", ["b"], 1), None)
    assert capsys.readouterr().err == ""
    monkeypatch.setenv("COLCON_PREFIX_PATH", str(ws / "gone/install"))
    assert find_package("pkg_one") is None
