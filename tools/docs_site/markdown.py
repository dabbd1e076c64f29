"""Markdown of pages: its headings, its fenced blocks, and its links, which point to files and on the site to pages."""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NamedTuple

FENCE = re.compile(r"^( *)(```+)(.*)$")
HEADING = re.compile(r"^(#+) (.*?)(?: \{ *#([\w-]+) *\})?$")
LINK = re.compile(r"(!?)\[((?:[^\[\]]|\[[^\]]*\])*)\]\(([^)\s]+)\)")
CODE = re.compile(r"`[^`]+`")
TITLE = re.compile(r'title="([^"]+)"')
DIRECTIVE = re.compile(r"^ *<!-- run: (.*?) -->$")


class Block(NamedTuple):
    """A fenced block: its info string in two halves, its text, where it is, and what stands before it for the tests."""

    language: str
    title: str
    text: str
    line: int
    """Number of its first fence, from 1."""
    directive: str = ""
    """Words of a comment `<!-- run: ... -->` on the line before."""


def parts(text: str) -> Iterator[tuple[str, str]]:
    """Yield the lines of a page, each with where it stands: `outside` of fenced blocks, `inside`, `opens` or `closes`.

    A fence closes a block if it is as long as the one that opened it, and has no more words: blocks can show fences.
    """
    opened = ""
    for line in text.splitlines():
        match = FENCE.match(line)
        if not opened:
            opened = match[2] if match else ""
            yield line, "opens" if match else "outside"
        elif match and len(match[2]) >= len(opened) and not match[3].strip():
            opened = ""
            yield line, "closes"
        else:
            yield line, "inside"


def blocks(text: str) -> list[Block]:
    """List the fenced blocks of a page."""
    found: list[Block] = []
    lines = text.splitlines()
    start: int | None = None
    for number, (_, place) in enumerate(parts(text)):
        if place == "opens":
            start = number
        elif place == "closes":
            assert start is not None
            found.append(_block(lines, start, number))
            start = None
    assert start is None, f"a block is not closed: line {start + 1}"
    return found


def _block(lines: list[str], start: int, end: int) -> Block:
    match = FENCE.match(lines[start])
    assert match is not None
    language, _, options = match[3].strip().partition(" ")
    title = TITLE.search(options)
    said = DIRECTIVE.match(lines[start - 1]) if start else None
    indent = len(match[1])
    text = "".join(line[indent:] + "\n" for line in lines[start + 1 : end])
    return Block(language, title[1] if title else "", text, start + 1, said[1] if said else "")


def outside_blocks(text: str, change: Callable[[str], str]) -> str:
    """Return a page whose lines outside of its fenced blocks are changed."""
    made = [change(line) if place == "outside" else line for line, place in parts(text)]
    return "\n".join(made) + "\n"


def headings(text: str) -> list[tuple[int, str]]:
    """List the headings of a page: their level and words."""
    found: list[tuple[int, str]] = []

    def note(line: str) -> str:
        if match := HEADING.match(line):
            found.append((len(match[1]), match[2]))
        return line

    outside_blocks(text, note)
    return found


def slugs(text: str) -> list[str]:
    """Return the anchors of a page's headings, as the site makes them."""
    made: list[str] = []
    for _, words in headings(text):
        plain = re.sub(r"[^\w\s-]", "", words.lower()).strip()
        slug = re.sub(r"[-\s]+", "-", plain)
        count = sum(each == slug or re.fullmatch(re.escape(slug) + r"_\d+", each) is not None for each in made)
        made.append(f"{slug}_{count}" if count else slug)
    return made


def with_anchors(text: str, anchors: list[str]) -> str:
    """Return a page whose headings have the given anchors, so that links to them hold in each language."""
    waiting = iter(anchors)

    def mark(line: str) -> str:
        match = HEADING.match(line)
        return f"{match[1]} {match[2]} {{ #{next(waiting)} }}" if match else line

    return outside_blocks(text, mark)


def with_site_links(text: str, source: Path, address: str, known: dict[Path, str]) -> str:
    """Return a page with links as they are on the site.

    Args:
        text: The page.
        source: File that its links are relative to.
        address: The page's own place on the site.
        known: Places on the site of files. Links to other files, such as code, become plain words.
    """

    def replaced(match: re.Match[str]) -> str:
        target, _, anchor = match[3].partition("#")
        if "://" in target or not target or target.startswith("mailto:"):
            return match[0]
        place = known.get((source.parent / target).resolve())
        if place is None:
            return "" if match[1] else match[2]
        relative = os.path.relpath(place, Path(address).parent).replace(os.sep, "/")
        return f"{match[1]}[{match[2]}]({relative}{'#' + anchor if anchor else ''})"

    return outside_blocks(text, lambda line: LINK.sub(replaced, line))


def with_site_tables(text: str) -> str:
    """Return a page whose tables have plain `|` in their code: the site needs no backslash there, and would show it."""

    def plain(line: str) -> str:
        return CODE.sub(lambda code: code[0].replace("\\|", "|"), line) if line.startswith("|") else line

    return outside_blocks(text, plain)


def without_directives(text: str) -> str:
    """Return a page without its comments `<!-- run: ... -->`, which are for the tests."""
    return outside_blocks(text, lambda line: "" if DIRECTIVE.match(line) else line)
