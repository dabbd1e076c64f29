"""One source of code for both languages: the fenced blocks of a Portuguese page are those of the English one."""

from __future__ import annotations

from tools.docs_site.markdown import blocks, parts
from tools.docs_site.pages import Page, pages


def pairs() -> list[tuple[Page, Page]]:
    """List the translated pages: the English and the Portuguese one."""
    both = zip(pages("en"), pages("pt"), strict=True)
    return [(english, other) for english, other in both if other.is_translated and english.source and other.source]


def copy_code() -> None:
    """Write the English blocks into the Portuguese pages, in their order."""
    for english, other in pairs():
        assert other.source is not None
        other.source.write_text(with_code_of(english.text(), other.text(), other.address), encoding="utf-8")


def with_code_of(english: str, other: str, name: str) -> str:
    """Return a page whose blocks are those of the English page; it has as many, perhaps empty ones.

    Raises:
        ValueError: If the number of blocks differs.
    """
    expected = raw_blocks(english)
    if len(expected) != len(blocks(other)):
        raise ValueError(f"{name}: {len(expected)} blocks in English, {len(blocks(other))} in Portuguese")
    made: list[str] = []
    waiting = iter(expected)
    for line, place in parts(other):
        if place == "opens":
            made += next(waiting)
        elif place == "outside":
            made.append(line)
    return "\n".join(made) + "\n"


def raw_blocks(text: str) -> list[list[str]]:
    """List the blocks of a page with their fences, as lines."""
    lines = text.splitlines()
    found: list[list[str]] = []
    for block in blocks(text):
        count = block.text.count("\n")
        found.append(lines[block.line - 1 : block.line + count + 1])
    return found
