"""Build of the documentation site: gathers the pages of both languages; Zensical makes one site of them, strictly."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

from tools.docs_site.markdown import (
    headings,
    slugs,
    with_anchors,
    with_site_links,
    with_site_tables,
    without_directives,
)
from tools.docs_site.pages import DOCS, LANGUAGES, ROOT, Page, addresses, listing, pages

GATHERED = ROOT / "build" / "docs"
SITE = GATHERED / "site"
PICTURES = (".png", ".svg")
NOTES = {"pt": '!!! note "Em inglês"\n\n    A referência existe só em inglês.\n'}
"""Note on top of a page that is in English on a site of another language."""
SUMMARIES = {
    "en": "ROS 2 nodes from pip install: nodes, topics, services and a simulated robot, in Python.",
    "pt": "Nodes de ROS 2 com pip install: nodes, topics, services e um robô simulado, em Python.",
}

CONFIGURATION = """\
[project]
site_name = "robolink"
site_description = "{summary}"
copyright = "Apache-2.0"
docs_dir = "{docs}"
site_dir = "{site}"
use_directory_urls = false
extra_javascript = ["{script}"]
nav = [
{nav}
]

[project.theme]
language = "{language}"
font = false
features = ["content.code.copy", "navigation.footer", "navigation.indexes", "navigation.tabs", "navigation.top"]

[[project.theme.palette]]
media = "(prefers-color-scheme: light)"
scheme = "default"
toggle.icon = "lucide/sun"
toggle.name = "{dark}"

[[project.theme.palette]]
media = "(prefers-color-scheme: dark)"
scheme = "slate"
toggle.icon = "lucide/moon"
toggle.name = "{light}"

[project.extra]
generator = false

{alternates}
"""
SCRIPT = "opened_from_file.js"
"""Script of the pages, beside this module, which says how to search on a site that no server serves."""
SERVE = "python -m http.server --directory"
"""Command that serves a site, without its folder."""
SEARCH_NEEDS = {
    "en": "Opened from a file, the site cannot be searched. Type this, then open http://localhost:8000:",
    "pt": "Aberto de um arquivo, o site não tem busca. Digite isto e abra http://localhost:8000:",
}
TOGGLES = {"en": ("Dark", "Light"), "pt": ("Escuro", "Claro")}
TAGS = {"en": "en", "pt": "pt-BR"}


def build() -> int:
    """Make the site in site/; return the exit code, which is not 0 if a link leads nowhere."""
    shutil.rmtree(SITE, ignore_errors=True)
    for language in LANGUAGES:
        gather(language)
        code = zensical(language)
        if code:
            return code
    for file in SITE.rglob("*.html"):
        file.write_text(with_language_menu(file), encoding="utf-8")
    return 0


def gather(language: str) -> None:
    """Write the pages of a language, with the pictures, as Zensical wants them."""
    folder = GATHERED / language
    shutil.rmtree(folder, ignore_errors=True)
    known = addresses() | pictures()
    for page in pages(language):
        file = folder / page.address
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(finished(page, known), encoding="utf-8")
    for source, place in pictures().items():
        (folder / place).parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(source, folder / place)
    (folder / SCRIPT).write_text(script(language), encoding="utf-8")
    (GATHERED / f"{language}.toml").write_text(configuration(language), encoding="utf-8")


def finished(page: Page, known: dict[Path, str]) -> str:
    """Return a page's text as it is on the site: links between pages, and the English anchors in both languages."""
    text = with_site_tables(without_directives(page.text()))
    if page.source is None:
        return _noted(text, page)
    text = with_site_links(text, page.source, page.address, known)
    english = next(each for each in pages("en") if each.address == page.address)
    text = with_anchors(text, slugs(english.text()))
    if page.address.endswith("/index.md"):
        text += contents(page)
    return _noted(text, page)


def _noted(text: str, page: Page) -> str:
    """Return a page with the note on top that it is in English, if its site is in another language."""
    if page.is_translated:
        return text
    first, _, rest = text.partition("\n")
    return f"{first}\n\n{NOTES[page.language]}{rest}"


def script(language: str) -> str:
    """Return the script of the pages in a language: the words that it shows, and where the site is from its folder."""
    text = Path(__file__).with_name(SCRIPT).read_text(encoding="utf-8")
    said = {"words": SEARCH_NEEDS[language], "command": SERVE, "site": "." if language == "en" else ".."}
    return f"const SAID = {json.dumps(said)};\n{text}"


def contents(index: Page) -> str:
    """Return a list of the pages of a part, for the page on which it begins."""
    part = Path(index.address).parent.as_posix() + "/"
    listed = [each for each in pages(index.language) if each.address.startswith(part) and each != index]
    lines = [f"- [{headings(each.text())[0][1]}]({Path(each.address).name})" for each in listed]
    return "\n" + "\n".join(lines) + "\n"


def pictures() -> dict[Path, str]:
    """Return the place on the site of each picture of docs/."""
    return {each: f"pictures/{each.name}" for each in (DOCS / "pictures").glob("*") if each.suffix in PICTURES}


def configuration(language: str) -> str:
    """Return the settings for Zensical."""
    dark, light = TOGGLES[language]
    return CONFIGURATION.format(
        summary=SUMMARIES[language],
        docs=language,
        site=Path(os.path.relpath(SITE if language == "en" else SITE / language, GATHERED)).as_posix(),
        nav="\n".join(navigation(language)),
        script=SCRIPT,
        language=TAGS[language],
        dark=dark,
        light=light,
        alternates="\n".join(alternates()),
    )


def navigation(language: str) -> list[str]:
    """Return the lines of the menu: the four parts with the titles of their pages."""
    lines = ['    {"robolink" = "index.md"},']
    listed = pages(language)
    for part, described in listing()["parts"].items():
        entries = [each for each in listed if each.address.startswith(part + "/")]
        titles = [f'{{"{_quoted(headings(each.text())[0][1])}" = "{each.address}"}}' for each in entries]
        lines.append(f'    {{"{described["title"][language]}" = [{", ".join(titles)}]}},')
    return lines


def _quoted(title: str) -> str:
    return title.replace("\\", "\\\\").replace('"', '\\"').replace("`", "")


def alternates() -> list[str]:
    """Return the language menu; `with_language_menu` gives each page its own links."""
    names = listing()["languages"]
    return [
        f'[[project.extra.alternate]]\nname = "{names[each]}"\nlink = "/{each}/"\nlang = "{TAGS[each]}"'
        for each in LANGUAGES
    ]


def with_language_menu(file: Path) -> str:
    """Return a page of HTML whose language menu leads to the same page in the other language."""
    place = file.relative_to(SITE)
    if place.parts[0] == "pt":
        place = Path(*place.parts[1:])
    text = file.read_text(encoding="utf-8")
    for language in LANGUAGES:
        target = SITE / place if language == "en" else SITE / language / place
        relative = Path(os.path.relpath(target, file.parent)).as_posix()
        text = re.sub(rf'href="/{language}/" hreflang', f'href="{relative}" hreflang', text)
    return text


def zensical(language: str) -> int:
    """Run Zensical for one language; return its exit code, and say what it says if it fails."""
    settings, quiet = str(GATHERED / f"{language}.toml"), {**os.environ, "NO_COLOR": "1"}
    command = [sys.executable, "-m", "zensical", "build", "--strict", "--clean", "-f", settings]
    done = subprocess.run(command, capture_output=True, text=True, encoding="utf-8", check=False, env=quiet)
    if done.returncode:
        sys.stderr.write(done.stdout + done.stderr.partition("Traceback")[0])
    return done.returncode
