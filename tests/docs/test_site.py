"""The documentation site: the same pages and code in both languages, links that lead somewhere, short sentences."""

from __future__ import annotations

import re
import shutil
import subprocess
from functools import cache
from pathlib import Path
from typing import Any

import pytest
import yaml

from tools.docs_site.build import SEARCH_NEEDS, SERVE, finished, script
from tools.docs_site.markdown import LINK, blocks, headings, outside_blocks, slugs, with_site_tables
from tools.docs_site.pages import DOCS, LANGUAGES, Page, addresses, pages
from tools.docs_site.same_code import pairs, with_code_of

PORTUGUESE = [other for _, other in pairs()]
WRITTEN = [each for language in LANGUAGES for each in pages(language) if each.source and each.is_translated]
LEARN = [each for each in WRITTEN if each.address.startswith("learn/")]
LONGEST = 30
"""Words of a sentence."""


def name_of(page: Page) -> str:
    return f"{page.language}/{page.address}"


def test_each_page_but_the_reference_is_there_in_both_languages() -> None:
    english = [each.address for each in pages("pt") if not each.is_translated]
    assert english == [each.address for each in pages("en") if each.address.startswith("reference/")]
    assert not (DOCS / "pt" / "reference").exists()
    assert len({name_of(each) for each in pages("en")}) == len(pages("en")), "a page stands twice in docs/site.yaml"
    assert [name_of(each) for each in WRITTEN if each.source and not each.source.is_file()] == []


def test_each_file_is_on_the_site() -> None:
    listed = {each.source for each in WRITTEN}
    files = {file for file in DOCS.rglob("*.md") if "development" not in file.parts}
    assert files - listed == set(), "list it in docs/site.yaml"


@pytest.mark.parametrize("page", PORTUGUESE, ids=name_of)
def test_both_languages_have_the_same_code_and_parts(page: Page) -> None:
    english = next(each for each in pages("en") if each.address == page.address)
    wanted = [(each.language, each.title, each.text) for each in blocks(english.text())]
    found = [(each.language, each.title, each.text) for each in blocks(page.text())]
    assert found == wanted, "run: python -m tools.docs_site same-code"
    levels = [level for level, _ in headings(english.text())]
    assert [level for level, _ in headings(page.text())] == levels
    assert targets(page) == targets(english)


@pytest.mark.parametrize("page", PORTUGUESE, ids=name_of)
def test_tables_have_the_same_figures_in_both_languages(page: Page) -> None:
    """A figure that is measured again changes in both; 1,234.5 is 1.234,5 in Portuguese."""
    english = next(each for each in pages("en") if each.address == page.address)
    assert figures(page) == figures(english)


def figures(page: Page) -> list[list[str]]:
    """The digits of each number of each row of a table, sorted, since words change their order."""
    rows = [line for line in prose(page).splitlines() if line.startswith("|")]
    return [sorted(re.sub("[.,]", "", each) for each in re.findall(r"\d+(?:[.,]\d+)*", row)) for row in rows]


def targets(page: Page) -> list[str]:
    """Where the links of a page lead: addresses, files, and the pages that a link within the site means."""
    assert page.source is not None
    found = []
    for _, _, target in LINK.findall(prose(page)):
        name, _, anchor = target.partition("#")
        file = (page.source.parent / name).resolve()
        place = target if "://" in name else addresses().get(file, file.name) if name else ""
        found.append(f"{place}#{anchor}")
    return found


@pytest.mark.parametrize("page", WRITTEN, ids=name_of)
def test_its_links_lead_somewhere(page: Page) -> None:
    assert page.source is not None
    for _, _, target in LINK.findall(prose(page)):
        name, _, anchor = target.partition("#")
        if "://" in name:
            continue
        file = (page.source.parent / name).resolve() if name else page.source
        assert file.exists(), f"{name_of(page)}: {target}"
        if anchor:
            english = next(each for each in pages("en") if each.address == page.address)
            text = file.read_text(encoding="utf-8") if name else english.text()  # the site's anchors are English
            assert anchor in slugs(text), f"{name_of(page)}: {target}"


# What learn pages promise


def prose(page: Page) -> str:
    """The page without its blocks and comments."""
    lines: list[str] = []

    def keep(line: str) -> str:
        lines.append("" if line.startswith("<!--") else line)
        return line

    outside_blocks(re.sub(r"^ *```.*?^ *```$", "```\n```\n\n", page.text(), flags=re.DOTALL | re.MULTILINE), keep)
    return "\n".join(lines)


def sentences(page: Page) -> list[str]:
    """The sentences of a page; a line of a list or a table, and what follows a colon, is one of its own."""
    text = re.sub(r"`[^`]*`", "code", prose(page))
    paragraphs = re.split(r"\n\s*\n|\n(?=\s*(?:[-*|#]|\d+\.))", text)
    return [each for part in paragraphs for each in re.split(r"(?<=[.!?:])\s+|\|", " ".join(part.split())) if each]


@pytest.mark.parametrize("page", LEARN, ids=name_of)
def test_its_sentences_are_short(page: Page) -> None:
    long = [each for each in sentences(page) if len(re.findall(r"[\w'-]+", each)) > LONGEST]
    assert long == []


@pytest.mark.parametrize("page", LEARN, ids=name_of)
def test_a_picture_stands_on_top(page: Page) -> None:
    first = page.text().split("\n\n")[1]
    assert re.fullmatch(r"!\[.+\]\((?:\.\./)+pictures/\w+\.(svg|png)\)", first)


@cache
def terms() -> list[dict[str, Any]]:
    read: list[dict[str, Any]] = yaml.safe_load((DOCS / "terms.yaml").read_text(encoding="utf-8"))
    return read


@pytest.mark.parametrize("language", LANGUAGES)
@pytest.mark.parametrize("number", range(len(terms())), ids=lambda number: terms()[number]["en"])
def test_a_term_is_explained_where_it_comes_first(number: int, language: str) -> None:
    """Its first place, over all pages in their order, is in bold, and the sentence around it explains it."""
    word = re.escape(terms()[number][language])
    found = re.compile(rf"(?<![\w/*-])(\*\*)?{word}s?(?![\w-])", re.IGNORECASE)
    learn = [each for each in LEARN if each.language == language]
    for page in learn:
        text = re.sub(r"`[^`]*`|\]\([^)]*\)|!\[[^\]]*\]", "", "\n".join(prose(page).splitlines()[1:]))
        text = "\n".join(line for line in text.splitlines() if not line.startswith("#"))
        if match := found.search(text):
            assert match[1], f"{name_of(page)}: '{text[max(0, match.start() - 40) : match.end() + 40]}'"
            return
    pytest.fail(f"no page has it: {word}")


def portuguese_texts() -> dict[str, str]:
    """The Portuguese that people read, by its place: pages, exercises, and the words of commands and of the view."""
    root = DOCS.parent
    texts = {name_of(page): prose(page) for page in WRITTEN if page.language == "pt"}
    texts["README.pt-BR.md"] = re.sub(
        r"^```.*?^```$", "", (root / "README.pt-BR.md").read_text("utf-8"), flags=re.S | re.M
    )
    for file in (*root.glob("robolink/learn/exercises/*/exercise.yaml"), *root.glob("robolink/view/page/**/*.js")):
        texts[str(file.relative_to(root))] = file.read_text(encoding="utf-8")
    for file in root.glob("robolink/*/*.py"):
        if re.search(r"^\w+: Words = ", source := file.read_text(encoding="utf-8"), re.MULTILINE):
            texts[str(file.relative_to(root))] = source
    return texts


@pytest.mark.parametrize("term", [each for each in terms() if "not" in each], ids=lambda term: term["not"])
def test_portuguese_has_one_word_for_a_term(term: dict[str, str]) -> None:
    """The one of courses and commands: a page that says nó beside exercises that say node speaks of two things."""
    other = re.compile(rf"(?<![\w(]){term['not']}s?(?!\w)", re.IGNORECASE)
    found = {
        place: text[max(0, match.start() - 40) : match.end() + 40]
        for place, text in portuguese_texts().items()
        if (match := other.search(re.sub(r"`[^`]*`|\]\([^)]*\)", "", text)))
    }
    assert found == {}, f"the word is {term['pt']} (docs/terms.yaml)"


def test_terms_are_all_that_is_in_bold() -> None:
    for language in LANGUAGES:
        text = "\n".join(prose(page) for page in LEARN if page.language == language)
        bold = {each.lower() for each in re.findall(r"\*\*(..+?)\*\*", text)}
        known = {each[language].lower() for each in terms()}
        assert bold - known - {f"{each}s" for each in known} == set()


def test_comments_for_the_tests_are_not_on_the_site() -> None:
    page = next(each for each in pages("en") if each.address == "reference/bags.md")
    assert "<!-- run: each -->" in page.text()
    text = finished(page, {})
    assert "<!--" not in text
    assert [each.text for each in blocks(text)] == [each.text for each in blocks(page.text())]


def test_pictures_are_made_by_the_script() -> None:
    from tools.docs_site.pictures import FOLDER, PICTURES

    assert {each.stem for each in FOLDER.glob("*.svg")} == {*PICTURES, "follow"}  # follow.svg: tools/picture.py
    assert {Path(each).suffix for each in FOLDER.iterdir()} <= {".svg", ".png"}


def test_tables_show_a_bar_in_code_without_its_backslash() -> None:
    page = "| `en\\|pt` | a \\| b |\n\n`a\\|b`\n\n```text\n| `a\\|b` |\n```\n"
    assert with_site_tables(page) == page.replace("`en\\|pt`", "`en|pt`")


def test_a_block_can_show_fences() -> None:
    page = "# A\n\n````markdown\n```text\n# B\n```\n````\n\n# C\n"
    assert [(each.language, each.text) for each in blocks(page)] == [("markdown", "```text\n# B\n```\n")]
    assert [words for _, words in headings(page)] == ["A", "C"]
    assert with_code_of(page, page.replace("```text\n# B\n```\n", ""), "page") == page


IN_A_PAGE = """
const shown = [];
const element = () => ({ parts: [], append(...parts) { this.parts.push(...parts); } });
globalThis.location = { protocol: new URL(process.argv[1]).protocol };
globalThis.document = {
  currentScript: { src: process.argv[1] },
  createElement: element,
  querySelector: () => ({ prepend: (note) => shown.push(...note.parts.map((each) => each.textContent ?? each)) }),
};
"""


@pytest.mark.processes
@pytest.mark.skipif(shutil.which("node") is None, reason="node is not installed")
@pytest.mark.parametrize(
    ("source", "language", "folder"),
    [
        ("file:///home/jos%C3%A9%20s/site/opened_from_file.js", "en", "/home/josé s/site"),
        ("file:///home/a/site/pt/opened_from_file.js", "pt", "/home/a/site"),
        ("file:///C:/site/opened_from_file.js", "en", "C:/site"),
        ("http://localhost:8000/opened_from_file.js", "en", ""),
    ],
)
def test_a_page_opened_from_a_file_says_how_to_search(source: str, language: str, folder: str) -> None:
    program = IN_A_PAGE + script(language) + "console.log(shown.join(''))"
    done = subprocess.run(["node", "-e", program, source], capture_output=True, encoding="utf-8", check=True)
    assert done.stdout == (f'{SEARCH_NEEDS[language]} {SERVE} "{folder}"\n' if folder else "\n")
