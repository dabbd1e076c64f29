"""Damaged .db3 files: what sqlite can still read of one that was cut or overwritten is shown, played and made whole."""

from __future__ import annotations

from pathlib import Path

import pytest

from robolink.bag.converting import reindex
from robolink.bag.reader import open_bag
from robolink.bag.topic import BagError
from robolink.cli.main import main
from tests.support.bags import START, Said, read, read_by_rosbags, text, write

MANY = [
    Said("/chatter" if i % 3 else "/map", START + i * 10**6, text(f"{i} {'x' * (500 if i % 50 else 9000)}"))
    for i in range(2000)
]
"""A megabyte of messages; each 50th has pages of its own."""
Captured = pytest.CaptureFixture[str]


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    path = tmp_path_factory.mktemp("whole") / "bag"
    write(path, MANY, storage="sqlite3")
    return (path / "bag_0.db3").read_bytes()


@pytest.fixture
def bag(tmp_path: Path) -> Path:
    write(tmp_path / "bag", MANY[:1], storage="sqlite3")
    return tmp_path / "bag"


def found_in(bag: Path, *, reverse: bool = False) -> list[Said]:
    with open_bag(bag) as reader:
        found = [Said(each.topic, each.log_time, bytes(each.data)) for each in reader.messages(reverse=reverse)]
        assert any("is damaged" in each for each in reader.problems)
    return found


@pytest.mark.parametrize("share", [0.25, 0.5, 0.75, 0.99])
def test_a_file_that_was_cut_gives_all_that_comes_before(bag: Path, whole: bytes, share: float) -> None:
    (bag / "bag_0.db3").write_bytes(whole[: int(len(whole) * share)])
    found = found_in(bag)
    assert len(found) > (share - 0.08) * len(MANY)  # the rest of a page, and the index, which has a part of each row
    assert found == MANY[: len(found)]
    assert found_in(bag, reverse=True) == found[::-1]


@pytest.mark.slow
@pytest.mark.parametrize("page", [20, 150, 200])
def test_a_page_in_the_middle_costs_what_was_in_it(bag: Path, whole: bytes, page: int) -> None:
    at = page * 4096
    (bag / "bag_0.db3").write_bytes(whole[:at] + b"\xff" * 4096 + whole[at + 4096 :])
    with open_bag(bag) as reader:
        found = [Said(each.topic, each.log_time, bytes(each.data)) for each in reader.messages()]
    saved = [each for each in MANY if each in set(found)]
    assert found == saved
    assert len(saved) > len(MANY) - 100


@pytest.mark.slow
def test_every_verb_works_with_half_a_file(
    bag: Path, whole: bytes, tmp_path: Path, capsys: Captured, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    (bag / "bag_0.db3").write_bytes(whole[: len(whole) // 2])
    count = len(found_in(bag))
    assert main(["bag", "info", "bag"]) == 0
    shown = capsys.readouterr()
    assert f"Messages:          {count}" in shown.out
    assert "messages of it can be read" in shown.err
    assert main(["bag", "convert", "bag", "whole"]) == 0
    assert read(tmp_path / "whole") == MANY[:count]
    lines: list[str] = []
    assert reindex(bag, lines.append).message_count == count
    assert lines[-1].endswith("bag_0.db3 is whole again; the damaged file is bag_0.db3.damaged")
    assert read(bag) == MANY[:count] == read_by_rosbags(bag).messages
    assert (bag / "bag_0.db3.damaged").stat().st_size == len(whole) // 2
    lines.clear()
    reindex(bag, lines.append)
    assert lines == []


def test_one_that_lost_its_list_of_topics_is_an_error_in_one_line(bag: Path, whole: bytes) -> None:
    for size in (100, 4096, 8000):
        (bag / "bag_0.db3").write_bytes(whole[:size])
        with pytest.raises(BagError, match=r"bag_0\.db3 (is damaged|is a sqlite3 database, but no bag)"):
            open_bag(bag)
        lines: list[str] = []
        with pytest.raises(BagError):
            reindex(bag, lines.append)
        assert (bag / "bag_0.db3").exists()
