"""Only regular files are read, up to a limit: what blocks or never ends is refused with the reason."""

from __future__ import annotations

import os
import socket
import sys
from pathlib import Path

import pytest

from robolink.documents import yamltext
from robolink.documents.mistakes import first_mistakes
from robolink.documents.yamlfile import mistakes, read_text
from robolink.exceptions import DocumentError
from robolink.exceptions import DocumentError as Error
from robolink.system.files import read_plain


def reason(path: Path | str, most: int = 100) -> str:
    with pytest.raises(OSError, match="it is") as caught:
        read_plain(path, most)
    return caught.value.strerror or ""


def test_a_file_is_read_up_to_its_limit(tmp_path: Path) -> None:
    path = tmp_path / "a"
    path.write_bytes(b"x" * 2_000_000)
    assert read_plain(path, 2_000_000) == b"x" * 2_000_000
    assert reason(path, 1_999_999) == "it is longer than 2 MB"
    assert reason(path, 500) == "it is longer than 0.5 kB"


def test_what_is_no_file_is_named(tmp_path: Path) -> None:
    assert reason(tmp_path) == "it is a folder, and no file"
    with pytest.raises(FileNotFoundError):
        read_plain(tmp_path / "none", 1)
    with pytest.raises(ValueError, match="null"):
        read_plain("a\0b", 1)


def test_what_blocks_or_never_ends_is_not_opened(tmp_path: Path) -> None:
    if sys.platform == "win32":
        pytest.skip("there are no FIFOs")
    os.mkfifo(tmp_path / "fifo")
    assert reason(tmp_path / "fifo") == "it is a FIFO, and no file"
    assert reason("/dev/zero") == "it is a device, and no file"
    with socket.socket(socket.AF_UNIX) as listening:
        listening.bind(str(tmp_path / "socket"))
        assert reason(tmp_path / "socket") == "it is a socket, and no file"
    (tmp_path / "link.yaml").symlink_to(tmp_path / "fifo")
    with pytest.raises(DocumentError, match=r"link\.yaml: cannot be read: it is a FIFO, and no file"):
        read_text(tmp_path / "link.yaml")


def test_a_fifo_that_takes_the_files_place_does_not_block(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    if sys.platform == "win32":
        pytest.skip("there are no FIFOs")
    (tmp_path / "file").write_text("")
    found = (tmp_path / "file").stat()
    os.mkfifo(tmp_path / "fifo")
    with monkeypatch.context() as first_look:
        first_look.setattr(Path, "stat", lambda _: found)
        assert reason(tmp_path / "fifo") == "it is a FIFO, and no file"


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux has /proc")
def test_a_file_that_says_it_is_empty_is_read_to_its_end() -> None:
    assert b"Name:" in read_plain("/proc/self/status", 100_000)


@pytest.mark.slow
def test_of_many_mistakes_the_first_are_told() -> None:
    def told(count: int) -> list[str]:
        return [
            str(each) for each in first_mistakes([Error(f"wrong {number}", "a.yaml", 1, 1) for number in range(count)])
        ]

    assert told(21)[-1] == "a.yaml:1:1: wrong 20"
    assert len(told(30_000)) == 21
    assert told(30_000)[-2:] == ["a.yaml:1:1: wrong 19", "a.yaml: and 29,980 more mistakes"]


@pytest.mark.slow
def test_a_file_of_mistakes_only_is_answered_shortly() -> None:
    text = "[" + "x, " * 40_000 + "]"
    found = mistakes("a.yaml", list[int], text=text)
    assert len(found) == 21
    assert str(found[-1]) == "a.yaml: and many more mistakes"
    assert str(found[0]) == "a.yaml:1:2: [0]: expected int, got 'x'"
    assert yamltext.MAX_NODES > 40_000
