"""No way to end a system leaves anything behind; `python -m tests.support.soak` does this a thousand times."""

import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.support.domains import free_domain

if sys.platform == "win32":
    pytest.skip("there are neither process groups nor SIGKILL", allow_module_level=True)

from tests.support.soak import KINDS, Soak, forgotten_memory

pytestmark = pytest.mark.processes


@pytest.fixture(scope="module")
def soak() -> Iterator[Soak]:
    with tempfile.TemporaryDirectory(prefix="soak") as name, free_domain() as domain:  # short, for a socket's path
        yield Soak(Path(name), domain, seed=6)


@pytest.mark.parametrize("kind", KINDS)
def test_nothing_is_left_after(soak: Soak, kind: str) -> None:
    soak.round(kind)


def test_and_the_next_start_clears_what_the_killed_could_not(soak: Soak) -> None:
    soak.round("kill_launcher_and_guardian")
    soak.round("stop")
    assert not soak.words()


@pytest.mark.skipif(not Path("/dev/shm").is_dir(), reason="shared memory has no files here: macOS")
def test_the_soak_sees_memory_that_nobody_has() -> None:
    with tempfile.NamedTemporaryFile(dir="/dev/shm") as file:
        assert Path(file.name).name in forgotten_memory()
    assert Path(file.name).name not in forgotten_memory()
