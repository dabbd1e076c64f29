"""Exit code of this process, noted as soon as it is certain, since Python does not tell it to exit handlers."""

from __future__ import annotations

_noted: list[int] = []


def note(code: int) -> None:
    """Note that this process ends now, with this exit code."""
    _noted[:] = [code]


def noted() -> int | None:
    """Return the exit code with which this process ends; None while that is not certain."""
    return _noted[0] if _noted else None
