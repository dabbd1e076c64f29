"""Templates: the text files of a new thing, with its name filled in."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

TEMPLATES = Path(__file__).parent / "files"
"""Folder of the templates: one folder for each kind, with the files as they are to lie."""

_SUFFIX, _DOT = ".template", "dot_"


def rendered(kind: str, words: Mapping[str, str]) -> dict[str, str]:
    """Return the files of a kind by their relative path, in the order of their names.

    Args:
        kind: Folder of templates: ``project``, ``node`` or ``world``.
        words: What stands for each placeholder; ``@NAME@`` is filled by ``words["NAME"]``, in names of files too.
    """
    folder = TEMPLATES / kind
    found = sorted(each for each in folder.rglob(f"*{_SUFFIX}"))
    return {
        _filled(_path(each.relative_to(folder)), words): _filled(each.read_text(encoding="utf-8"), words)
        for each in found
    }


def _path(template: Path) -> str:
    parts = [f".{each[len(_DOT) :]}" if each.startswith(_DOT) else each for each in template.parts]
    return "/".join(parts).removesuffix(_SUFFIX)


def _filled(text: str, words: Mapping[str, str]) -> str:
    for name, value in words.items():
        text = text.replace(f"@{name}@", value)
    return text
