"""A process starts anew when a file that it is made of is saved, and not before the file is whole."""

from __future__ import annotations

import ast
import os
import threading
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.supervisor.monitoring.file_watch import Changes, Imports, Stamp, Watch, parse

PATIENCE = 30.0


class Files:
    """Stamps of files that a test sets."""

    def __init__(self, *paths: str) -> None:
        self.stamps: dict[Path, Stamp] = {Path(each): (1, 1, 1) for each in paths}

    def changes(self) -> Changes:
        made = Changes(self.stamps.get)
        made.follow(self.stamps)
        return made

    def save(self, path: str, *stamp: int) -> None:
        self.stamps[Path(path)] = (stamp[0], stamp[1], stamp[2]) if stamp else None


# --- noticing -------------------------------------------------------------------------------------------------


def test_a_saved_file_counts_once_it_stands_still() -> None:
    files = Files("a.py", "b.py")
    changes = files.changes()
    assert changes.look() == set()
    files.save("a.py", 2, 1, 1)
    assert changes.look() == set()
    files.save("a.py", 3, 2, 1)
    assert changes.look() == set()
    assert changes.look() == {Path("a.py")}
    assert changes.look() == set()


def test_a_file_that_is_replaced_counts_when_the_new_one_is_there() -> None:
    files = Files("a.py")
    changes = files.changes()
    files.save("a.py")
    assert changes.look() == set()
    assert changes.look() == set()
    files.save("a.py", 1, 1, 2)
    assert changes.look() == set()
    assert changes.look() == {Path("a.py")}


def test_a_file_that_comes_back_as_it_was_is_no_news() -> None:
    files = Files("a.py")
    changes = files.changes()
    files.save("a.py")
    changes.look()
    files.save("a.py", 1, 1, 1)
    assert [changes.look() for _ in range(3)] == [set()] * 3


def test_a_file_that_is_followed_later_is_no_news_at_first() -> None:
    files = Files("a.py")
    changes = files.changes()
    files.save("b.py", 5, 5, 5)
    changes.follow([Path("b.py")])
    assert [changes.look() for _ in range(2)] == [set()] * 2
    files.save("b.py", 6, 5, 5)
    changes.look()
    assert changes.look() == {Path("b.py")}


@given(st.lists(st.none() | st.tuples(*[st.integers(0, 2)] * 3), max_size=20))
def test_whatever_was_saved_last_is_noticed(stamps: list[Stamp]) -> None:
    """However a file came to be as it is, two more looks at it are enough, and it counts once."""
    files = Files("a.py")
    changes = files.changes()
    counted: Stamp = (1, 1, 1)
    last = stamps[-1] if stamps else None
    for stamp in [*stamps, last, last]:
        files.stamps[Path("a.py")] = stamp
        if changes.look():
            counted = stamp
    assert last is None or counted == last
    assert changes.look() == set()


# --- what is imported -----------------------------------------------------------------------------------------


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    texts = {
        "nodes/follow.py": "import os\nimport helpers\nfrom shapes.round import Circle\n",
        "nodes/helpers.py": "def help():\n    import late\n",
        "nodes/late.py": "import helpers\n",
        "nodes/other.py": "",
        "nodes/shapes/__init__.py": "from . import base\n",
        "nodes/shapes/base.py": "",
        "nodes/shapes/round.py": "from .flat import *\nfrom ..unreachable import x\n",
        "nodes/shapes/flat.py": "",
        "src/pack/pack/__init__.py": "",
        "src/pack/pack/node.py": "from pack.parts import Part\nimport pack.more as more\nimport namespace.deep\n",
        "src/pack/pack/parts.py": "",
        "src/pack/pack/more.py": "",
        "lib/namespace/deep.py": "import pack.unused_name\n",
    }
    for name, text in texts.items():
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    return tmp_path


def names(found: set[Path], folder: Path) -> list[str]:
    return sorted(each.relative_to(folder).as_posix() for each in found)


def test_a_file_is_followed_with_what_it_imports_from_beside_it(folder: Path) -> None:
    assert names(Imports().of(folder / "nodes/follow.py"), folder / "nodes") == [
        "follow.py",
        "helpers.py",
        "late.py",
        "shapes/__init__.py",
        "shapes/base.py",
        "shapes/flat.py",
        "shapes/round.py",
    ]


def test_the_modules_of_a_package_are_found_by_its_name(folder: Path) -> None:
    assert names(Imports([folder / "lib"]).of(folder / "src/pack/pack/node.py"), folder) == [
        "lib/namespace/deep.py",
        "src/pack/pack/__init__.py",
        "src/pack/pack/more.py",
        "src/pack/pack/node.py",
        "src/pack/pack/parts.py",
    ]


def test_what_is_no_python_imports_nothing(tmp_path: Path) -> None:
    binary, broken = tmp_path / "a.bin", tmp_path / "b.py"
    binary.write_bytes(b"\0\1\2")
    broken.write_text("import os\nimport (")
    imports = Imports()
    assert imports.of(binary) == {binary}
    assert imports.of(broken) == {broken}
    assert imports.of(tmp_path / "missing.py") == {tmp_path / "missing.py"}


def test_a_file_that_is_broken_now_imports_what_it_did(folder: Path) -> None:
    imports, path = Imports(), folder / "nodes/late.py"
    assert imports.of(path) == {path, folder / "nodes/helpers.py"}
    path.write_text("import (")
    imports.forget(path)
    assert imports.of(path) == {path, folder / "nodes/helpers.py"}
    path.write_text("import other")
    assert imports.of(path) == {path, folder / "nodes/other.py"}
    path.write_text("")
    assert imports.of(path) == {path, folder / "nodes/other.py"}, "it is read again when it is known to be saved"


@given(st.binary(max_size=100) | st.text(max_size=100).map(str.encode))
def test_any_text_is_python_or_a_syntax_error(text: bytes) -> None:
    class Held:
        """A path to a file that holds the text."""

        def read_bytes(self) -> bytes:
            return text

    try:
        tree = parse(Held())  # type: ignore[arg-type]
    except SyntaxError:
        return
    assert isinstance(tree, ast.Module)


# --- restarting -----------------------------------------------------------------------------------------------


class Launched:
    """Notes what is restarted and what is said."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.restarted: list[str] = []
        self.said: list[str] = []
        self.happened = threading.Event()

    def restart(self, name: str) -> None:
        self.restarted.append(name)
        self.happened.set()

    def watch(self, *, every: float = 0.5, **files: list[str]) -> Watch:
        return Watch(
            {name: [self.folder / each for each in paths] for name, paths in files.items()},
            settings=[self.folder / "follow.yaml"],
            restart=self.restart,
            say=self.said.append,
            every=every,
        )


@pytest.fixture
def launched(folder: Path) -> Launched:
    (folder / "follow.yaml").write_text("nodes: []\n")
    return Launched(folder)


def look(watch: Watch) -> None:
    """Look until all that was saved stands still."""
    watch.look()
    watch.look()


def test_a_node_is_restarted_when_its_file_is_saved(launched: Launched, folder: Path) -> None:
    watch = launched.watch(follow=["nodes/follow.py"], other=["nodes/other.py"])
    look(watch)
    assert launched.restarted == []
    (folder / "nodes/other.py").write_text("x = 1\n")
    look(watch)
    assert launched.restarted == ["other"]
    assert launched.said == [f"{folder / 'nodes/other.py'} was saved"]
    look(watch)
    assert launched.restarted == ["other"]


def test_all_that_import_a_file_are_restarted(launched: Launched, folder: Path) -> None:
    watch = launched.watch(follow=["nodes/follow.py"], other=["nodes/other.py"], late=["nodes/late.py"])
    (folder / "nodes/helpers.py").write_text("from other import x\n")
    look(watch)
    assert launched.restarted == ["follow", "late"]
    launched.restarted.clear()
    (folder / "nodes/other.py").write_text("x = 1\n")
    look(watch)
    assert launched.restarted == ["follow", "other", "late"], "what is imported now counts from now on"


def test_a_module_that_is_saved_after_what_imports_it(launched: Launched, folder: Path) -> None:
    watch = launched.watch(other=["nodes/other.py"])
    (folder / "nodes/other.py").write_text("import os\nimport coming\nfrom shapes.square import Square\n")
    look(watch)
    assert launched.restarted == ["other"]
    for path in ("coming.py", "shapes/square.py", "coming.py"):
        launched.restarted.clear()
        (folder / "nodes" / path).write_text(f"size = {len(launched.said)}\n")
        look(watch)
        assert launched.restarted == ["other"], path
    (folder / "nodes/os.py").write_text("")
    look(watch)
    assert launched.restarted == ["other"], "Python has an os of its own"


def test_two_files_at_once_are_one_restart(launched: Launched, folder: Path) -> None:
    watch = launched.watch(follow=["nodes/follow.py"])
    (folder / "nodes/follow.py").write_text("import helpers\n")
    (folder / "nodes/helpers.py").write_text("")
    look(watch)
    assert launched.restarted == ["follow"]


def test_an_editor_that_writes_beside_and_renames(launched: Launched, folder: Path) -> None:
    watch = launched.watch(other=["nodes/other.py"])
    path = folder / "nodes/other.py"
    stamp = path.stat()
    for text in ("x = 1\n", "x = 2\n"):
        (folder / "nodes/.other.swp").write_text(text)
        path.replace(folder / "nodes/other.py~")
        watch.look()
        (folder / "nodes/.other.swp").replace(path)
        os.utime(path, ns=(stamp.st_mtime_ns, stamp.st_mtime_ns))
        look(watch)
    assert launched.restarted == ["other", "other"]


def test_a_syntax_error_holds_the_restart_up_until_it_is_mended(launched: Launched, folder: Path) -> None:
    watch = launched.watch(follow=["nodes/follow.py"], late=["nodes/late.py"])
    path = folder / "nodes/helpers.py"
    path.write_text("def help(:\n")
    look(watch)
    assert launched.restarted == []
    (told,) = launched.said
    assert told.startswith(f"{path}:1:10: ")
    assert told.endswith(": not restarted until that is mended: follow, late")
    (folder / "nodes/late.py").write_text("import helpers, other\n")
    look(watch)
    assert launched.restarted == [], "it would not start"
    path.write_text("def help(): ...\n")
    look(watch)
    assert launched.restarted == ["follow", "late"]


@pytest.mark.parametrize("text", [b"return 1\n", b"x = '\xff'\n", b"x = 1\0\n", b"if x:\nx = 1\n"])
def test_each_kind_of_mistake_is_said_with_its_place(text: bytes, launched: Launched, folder: Path) -> None:
    watch = launched.watch(other=["nodes/other.py"])
    (folder / "nodes/other.py").write_bytes(text)
    look(watch)
    assert launched.restarted == []
    assert len(launched.said) == 1
    assert "\n" not in launched.said[0]
    line = launched.said[0].removeprefix(f"{folder / 'nodes/other.py'}:").split(":")[0]
    assert int(line) in (1, 2)


def test_a_launch_file_that_changes_is_told_of(launched: Launched, folder: Path) -> None:
    watch = launched.watch(other=["nodes/other.py"])
    (folder / "follow.yaml").write_text("nodes: [other]\n")
    look(watch)
    look(watch)
    assert launched.restarted == []
    assert launched.said == [f"{folder / 'follow.yaml'} has changed: that counts when the system is started anew"]


def test_a_thread_looks_meanwhile_and_ends(launched: Launched, folder: Path) -> None:
    before, saved = set(threading.enumerate()), folder / "saved"
    saved.write_text("x = 1\n")
    with launched.watch(other=["nodes/other.py"], every=0.01):
        saved.replace(folder / "nodes/other.py")  # at once: half a save that stands still would count too
        assert launched.happened.wait(PATIENCE)
    assert set(threading.enumerate()) <= before
    assert launched.restarted == ["other"]
