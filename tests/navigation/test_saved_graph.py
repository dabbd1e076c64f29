"""Saved graphs: what is loaded is what was saved, and a file that is not one is refused with a reason."""

from __future__ import annotations

import contextlib
import functools
import io
import os
import tempfile
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from robolink.geometry.plane import Pose
from robolink.navigation import saved_graph
from robolink.navigation.mapper import Mapper, Options
from robolink.navigation.occupancy import Beams
from robolink.navigation.saved_graph import SavedGraphError, load, path_of, save
from tests.support.scanned_rooms import ROOM, points


def mapper_of(count: int = 5, loop: bool = True) -> Mapper:
    """Return a mapper of a few scans."""
    mapper = Mapper()
    for number in range(count):
        pose = Pose(2.0 + 0.6 * number, 2.0)
        scan = points(ROOM, pose, seed=number)
        mapper.process(Beams(scan, len(scan) - 3, (0.1, 0.0)), pose)
    if loop:
        mapper.graph.link(0, count - 1, Pose(0.6 * (count - 1)), np.diag([1e-4, 1e-4, 1e-5]))
    return mapper


@functools.cache
def saved() -> bytes:
    """Return the bytes of a file."""
    with tempfile.TemporaryDirectory() as folder:
        save(Path(folder) / "m.posegraph", mapper_of(3))
        return (Path(folder) / "m.posegraph").read_bytes()


def changed(path: Path, **arrays: Any) -> None:
    """Write a file again with other arrays; None leaves one out."""
    with np.load(path) as file:
        found = dict(file) | arrays
    with path.open("wb") as file_again:
        np.savez(file_again, **{name: array for name, array in found.items() if array is not None})


@pytest.mark.parametrize("count", [1, 5])
def test_what_is_loaded_is_what_was_saved(tmp_path: Path, count: int) -> None:
    before = mapper_of(count, loop=count > 1)
    save(tmp_path / "m.posegraph", before)
    after = load(tmp_path / "m.posegraph", Options(resolution=0.05))
    assert np.array_equal(before.graph.poses, after.graph.poses)
    for one, other in zip(before.graph.steps, after.graph.steps, strict=True):
        assert np.array_equal(one, other)
    assert [each[:3] for each in before.graph.loops] == [each[:3] for each in after.graph.loops]
    assert [each.beams.hits for each in before.keyframes] == [each.beams.hits for each in after.keyframes]
    assert np.mean(before.grid().cells != after.grid().cells) < 0.001  # ends are saved to a tenth of a micrometre
    assert [each.name for each in tmp_path.iterdir()] == ["m.posegraph"]


def test_names_have_their_ending_once() -> None:
    assert path_of("maps/office").name == "office.posegraph"
    assert path_of("maps/office.posegraph").name == "office.posegraph"
    assert path_of("maps/v1.2").name == "v1.2.posegraph"
    assert path_of("~/x") == Path.home() / "x.posegraph"


def test_nothing_is_not_saved(tmp_path: Path) -> None:
    with pytest.raises(SavedGraphError, match="nothing to save"):
        save(tmp_path / "m.posegraph", Mapper())
    assert list(tmp_path.iterdir()) == []


def test_a_write_that_fails_leaves_the_file_before(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "m.posegraph"
    save(path, mapper_of(2))
    before = path.read_bytes()

    def full(_: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(OSError, match="No space"):
        save(path, mapper_of(5))
    assert path.read_bytes() == before
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize(
    ("arrays", "said"),
    [
        ({"format": np.array([2])}, "expected 1, got 2: it is of another robolink"),
        ({"poses": None}, "poses"),
        ({"poses": np.zeros((5, 2))}, r"poses: expected the shape .*3.*, got \(5, 2\)"),
        ({"poses": np.zeros((4, 3))}, "steps: expected 3 rows"),
        ({"poses": np.full((5, 3), np.nan)}, "poses: not all numbers are finite"),
        ({"poses": np.full((5, 3), 1e300)}, "less than 1e12"),
        ({"poses": np.zeros((5, 3), np.float32)}, "poses: expected float64"),
        ({"poses": np.array([object()] * 5)}, "allow_pickle"),
        ({"counts": np.full((5, 2), -1)}, "expected"),
        ({"counts": np.tile([360, 361], (5, 1))}, "expected hits from 0"),
        ({"loop_ends": np.array([[0, 9]])}, "loop_ends: expected numbers from 0 to 4"),
        ({"spreads": np.zeros((4, 3, 3))}, "spreads: expected covariances"),
        ({"ends": np.zeros((3, 2), np.float32)}, "ends: expected 1.* rows"),
    ],
)
def test_a_file_with_a_mistake_says_which(tmp_path: Path, arrays: dict[str, Any], said: str) -> None:
    path = tmp_path / "m.posegraph"
    save(path, mapper_of())
    changed(path, **arrays)
    with pytest.raises(SavedGraphError, match=said) as error:
        load(path)
    assert str(path) in str(error.value)


def test_files_that_are_not_there_or_something_else_say_so(tmp_path: Path) -> None:
    with pytest.raises(SavedGraphError, match=r"none.posegraph: No such file"):
        load(tmp_path / "none.posegraph")
    (tmp_path / "ros.posegraph").write_bytes(b"\x16\x00\x00\x00\x00\x00\x00\x00serialization::archive\x12\x04")
    with pytest.raises(SavedGraphError, match="ROS's own cannot be read"):
        load(tmp_path / "ros.posegraph")


@pytest.mark.slow
@given(st.data())
@settings(max_examples=100, suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None)
def test_a_damaged_file_is_loaded_or_refused(tmp_path: Path, data: st.DataObject) -> None:
    path, file = tmp_path / "m.posegraph", io.BytesIO()
    file.write(saved())
    size = file.tell()
    for _ in range(data.draw(st.integers(1, 4))):
        file.seek(data.draw(st.integers(0, size - 1)))
        file.write(data.draw(st.binary(min_size=1, max_size=8)))
    cut = data.draw(st.integers(size // 2, size))
    path.write_bytes(file.getvalue()[:cut])
    with contextlib.suppress(SavedGraphError):
        load(path)


def test_a_giant_is_refused_before_it_is_unpacked(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "m.posegraph"
    monkeypatch.setattr(saved_graph, "_LARGEST", 2_000_000)
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive, archive.open("ends.npy", "w") as file:
        file.write(bytes(2_001_000))
    with pytest.raises(SavedGraphError, match="ends: 2001000 bytes are too many"):
        load(path)
