"""List of the site's pages: where each one's text is, in each language, and its address on the site."""

from __future__ import annotations

import functools
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml

ROOT = Path(__file__).resolve().parents[2]
DOCS = ROOT / "docs"
LIST = DOCS / "site.yaml"
LANGUAGES = ("en", "pt")
GENERATED = "generated"
"""Source of the pages that `tools/docs_site/reference.py` makes."""
ENGLISH = "reference"
"""Part that is English in every language: what one looks up changes with the code, and a translation falls behind."""


@dataclass(frozen=True)
class Page:
    """A page in one language; `source` is None if it is generated."""

    language: str
    address: str
    """Path on the site of its language: `learn/node.md`."""
    source: Path | None
    is_translated: bool = True
    """False if the text is English on a Portuguese site."""

    def text(self) -> str:
        """Return the text as it is written."""
        if self.source is None:
            from tools.docs_site.reference import text  # imports robolink, which few need

            return text(Path(self.address).stem)
        return self.source.read_text(encoding="utf-8")


@functools.cache  # each test of a page reads it
def listing() -> dict[str, Any]:
    """Return the content of docs/site.yaml."""
    read: dict[str, Any] = yaml.safe_load(LIST.read_text(encoding="utf-8"))
    return read


def folder(language: str) -> Path:
    """Return the folder of the pages of a language: English is docs/ itself."""
    return DOCS if language == "en" else DOCS / language


def pages(language: str) -> list[Page]:
    """List the written pages of a language, the home page first, in the order of the menu."""
    made = [Page(language, "index.md", folder(language) / "index.md")]
    for part, described in listing()["parts"].items():
        for entry in described["pages"]:
            name, source = next(iter(entry.items())) if isinstance(entry, dict) else (entry, None)
            made.append(_page(language, f"{part}/{name}.md", source))
    return made


def _page(language: str, address: str, source: str | None) -> Page:
    is_translated = language == "en" or not address.startswith(f"{ENGLISH}/")
    own = folder(language if is_translated else "en") / address
    if source == GENERATED:
        return Page(language, address, None, is_translated)
    return Page(language, address, own, is_translated)


def addresses() -> dict[Path, str]:
    """Return the address of each file that is a page, in whatever language."""
    return {each.source: each.address for language in LANGUAGES for each in pages(language) if each.source}
