"""Heap tuning: on where there is glibc, once, and never against the user's own settings."""

from __future__ import annotations

import ctypes
import os
import subprocess
import sys
from typing import Any

import pytest

from robolink.system import heap


@pytest.fixture
def calls(monkeypatch: pytest.MonkeyPatch) -> list[tuple[int, int]]:
    """The calls of mallopt, in a process that has not kept its heap yet."""
    made: list[tuple[int, int]] = []

    class Libc:
        def __init__(self, _: object) -> None: ...

        def malloc_trim(self, pad: int) -> int:
            made.append((0, pad))
            return 1

        def mallopt(self, name: int, value: int) -> int:
            made.append((name, value))
            return 1

    monkeypatch.setattr(heap, "_is_set", False)
    monkeypatch.setattr(ctypes, "CDLL", Libc)
    return made


def with_libc(monkeypatch: pytest.MonkeyPatch, answer: Any) -> None:
    def confstr(name: str) -> str:
        if isinstance(answer, Exception):
            raise answer
        return str(answer)

    monkeypatch.setattr(os, "confstr", confstr, raising=False)


def test_glibc_keeps_what_is_freed(monkeypatch: pytest.MonkeyPatch, calls: list[tuple[int, int]]) -> None:
    with_libc(monkeypatch, "glibc 2.36")
    heap.keep({})
    heap.keep({})
    assert dict(calls) == {-3: 32 << 20, -1: 64 << 20}
    assert len(calls) == 2


def test_the_memory_of_huge_messages_is_given_back_once_none_comes_any_more(
    monkeypatch: pytest.MonkeyPatch, calls: list[tuple[int, int]]
) -> None:
    with_libc(monkeypatch, "glibc 2.36")
    begun: list[None] = []
    monkeypatch.setattr(heap, "_begin_to_give", lambda: begun.append(None))
    monkeypatch.setattr(heap, "PAUSES", (0.01, 0.02))
    heap.note(heap.HUGE - 1)
    assert not begun
    heap.note(heap.HUGE)
    assert len(begun) == 1
    heap.give_back()
    assert calls[2:] == [(0, 0), (0, 0)]


@pytest.mark.parametrize("answer", ["", ValueError("unrecognized"), OSError("not here")])
def test_other_libraries_are_left_alone(
    monkeypatch: pytest.MonkeyPatch, calls: list[tuple[int, int]], answer: Any
) -> None:
    with_libc(monkeypatch, answer)
    heap.keep({})
    assert not calls


@pytest.mark.parametrize("missing", ["ctypes", "dlopen", "mallopt"])
def test_a_python_without_the_means_goes_on(monkeypatch: pytest.MonkeyPatch, missing: str) -> None:
    def library(_: object) -> object:
        if missing == "dlopen":
            raise OSError("Dynamic loading not supported")
        return object()

    with_libc(monkeypatch, "glibc 2.36")
    monkeypatch.setattr(heap, "_is_set", False)
    monkeypatch.setattr(ctypes, "CDLL", library)
    if missing == "ctypes":
        monkeypatch.setitem(sys.modules, "ctypes", None)
    heap.keep({})
    assert heap._is_set


def test_windows_is_left_alone(monkeypatch: pytest.MonkeyPatch, calls: list[tuple[int, int]]) -> None:
    monkeypatch.delattr(os, "confstr", raising=False)
    heap.keep({})
    assert not calls


@pytest.mark.parametrize(
    "environ", [{"MALLOC_TRIM_THRESHOLD_": "1"}, {"GLIBC_TUNABLES": "a.b=1:glibc.malloc.top_pad=1"}]
)
def test_the_users_own_settings_hold(
    monkeypatch: pytest.MonkeyPatch, calls: list[tuple[int, int]], environ: dict[str, str]
) -> None:
    with_libc(monkeypatch, "glibc 2.36")
    heap.keep(environ)
    assert not calls


PROGRAM = """
import resource
from robolink.system import heap
heap.keep({})
def faults():
    return resource.getrusage(resource.RUSAGE_SELF).ru_minflt
def message():
    first = bytearray(b"x" * 1_000_000)
    return [bytes(first), bytes(first), bytes(first)]
for _ in range(3):
    message()
before = faults()
for _ in range(20):
    message()
print(faults() - before)
"""


@pytest.mark.processes
@pytest.mark.skipif(not heap._has_glibc(), reason="only glibc trims so and can be told not to")
def test_large_messages_fault_no_page_in_twice() -> None:
    environ = {name: value for name, value in os.environ.items() if not name.startswith(("MALLOC_", "GLIBC_"))}
    said = subprocess.run([sys.executable, "-c", PROGRAM], capture_output=True, text=True, check=True, env=environ)
    assert int(said.stdout) < 500, "of 20,000 without"
