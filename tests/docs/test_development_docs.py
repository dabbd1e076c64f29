"""docs/development says what is so: its generated files are fresh, and every file and function it names is there."""

from __future__ import annotations

import ast
import os
import re
import runpy
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from tools.without_annex import is_of_missing

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "docs" / "development"
TOOL = runpy.run_path(str(ROOT / "tools" / "development_docs.py"))

GENERATED: dict[Path, str] = TOOL["written"]()

PLACE = re.compile(r"`([\w./-]+\.(?:py|toml|yaml|md)|Makefile)(?::([\w.]+))?`")
"""A place as the pages write it: `folder/file.py` or `folder/file.py:Class.method`."""

PLACEHOLDER = re.compile(r"[A-Z]{2}.*\.py")
"""A file that the reader makes: `cli/NOUN.py`."""


@pytest.mark.parametrize("path", GENERATED, ids=lambda path: path.name)
def test_generated_pages_are_fresh(path: Path) -> None:
    assert TOOL["is_fresh"](path, GENERATED[path]), (
        f"docs/development/{path.name} is out of date, since a docstring, a file's name or pyproject.toml's layers"
        f" changed. Renew it: {TOOL['RENEW']}"
    )


@pytest.mark.slow
def test_every_module_is_in_rooms() -> None:
    text: str = TOOL["rooms"]()
    for name in ("publisher", "inbox", "attachment", "supervisor"):
        assert f"| `{name}` | " in text
    assert " |  |" not in text  # a module without a docstring


def test_every_module_of_the_layers_is_in_the_picture() -> None:
    layers = [name for layer in TOOL["layers"]() for name in layer]
    assert len(layers) > 50
    assert layers == [name for _, names in TOOL["floors"]() for name in names]


def pages() -> list[Path]:
    return [*sorted(FOLDER.rglob("*.md")), ROOT / "CONTRIBUTING.md"]


def places(text: str) -> list[tuple[str, str]]:
    """Return the files, and the functions in them, that a page names; but for those that it says are new."""
    return [(each[1], each[2] or "") for each in PLACE.finditer(text) if not PLACEHOLDER.search(each[1])]


def wrong(path: str, name: str) -> str:
    """Return what is wrong about a place; '' if it is there."""
    candidates = [root / path for root in (ROOT, ROOT / "robolink", FOLDER)]
    file = next((each for each in candidates if each.is_file()), None)
    if file is None:
        return "" if is_of_missing(path) or is_of_missing(f"robolink/{path}") else f"{path}: no such file"
    if not name:
        return ""
    return "" if name in defined(file) else f"{path} defines no {name}"


@cache
def defined(path: Path) -> frozenset[str]:
    """Return the names that a module defines, `Class.method` and attributes of a class included."""
    return frozenset(_names(ast.parse(path.read_text(encoding="utf-8")).body, ""))


def _names(body: list[ast.stmt], above: str) -> Any:
    for each in body:
        if isinstance(each, (ast.FunctionDef, ast.AsyncFunctionDef)):
            yield above + each.name
        elif isinstance(each, ast.ClassDef):
            yield above + each.name
            yield from _names(each.body, f"{above}{each.name}.")
        elif isinstance(each, (ast.Assign, ast.AnnAssign)):
            targets = each.targets if isinstance(each, ast.Assign) else [each.target]
            yield from (above + target.id for target in targets if isinstance(target, ast.Name))


def test_places_are_found_and_wrong_ones_are_told() -> None:
    assert places("`wire/keys.py:format_key`, `Makefile`") == [("wire/keys.py", "format_key"), ("Makefile", "")]
    assert not wrong("transport/history.py", "Mailbox.take")
    assert wrong("transport/history.py", "Mailbox.takes") == "transport/history.py defines no Mailbox.takes"
    assert wrong("running/nowhere.py", "") == "running/nowhere.py: no such file"


@pytest.mark.parametrize("page", pages(), ids=lambda page: page.relative_to(ROOT).as_posix())
def test_every_file_and_function_that_a_page_names_is_there(page: Path) -> None:
    text = page.read_text(encoding="utf-8")
    found = [problem for problem in (wrong(*place) for place in places(text)) if problem]
    assert not found, "\n".join(found)


def test_the_tour_names_a_place_in_each_step() -> None:
    steps = re.findall(r"^\d+\. .*(?:\n .*)*", (FOLDER / "tour.md").read_text(encoding="utf-8"), re.MULTILINE)
    assert len(steps) >= 20
    assert [step for step in steps if not any(name for _, name in places(step))] == []


LINK = re.compile(r"\]\((?!https?:)([^)#]*)(?:#[^)]*)?\)")


@pytest.mark.parametrize(
    "page",
    [*sorted(ROOT.glob("*.md")), *sorted((ROOT / "docs").rglob("*.md"))],
    ids=lambda page: page.relative_to(ROOT).as_posix(),
)
def test_every_link_leads_to_a_file(page: Path) -> None:
    links = LINK.findall(page.read_text(encoding="utf-8"))
    gone = [link for link in links if link and not (page.parent / link).exists()]
    assert [link for link in gone if not is_of_missing(os.path.relpath(page.parent / link, ROOT))] == []


TERMS = re.findall(
    r"^\| ([a-z ]+) \| (`[^|]*`) \|$", (FOLDER / "glossary.md").read_text(encoding="utf-8"), re.MULTILINE
)


@pytest.mark.parametrize(("term", "where"), TERMS, ids=[term for term, _ in TERMS])
def test_a_usual_term_is_found_in_the_files_that_the_glossary_names(term: str, where: str) -> None:
    for path, _ in places(where):
        if is_of_missing(f"robolink/{path}"):
            continue
        assert term in (ROOT / "robolink" / path).read_text(encoding="utf-8").lower(), f"{path} never says {term}"


def test_the_glossary_leads_from_usual_terms_to_files() -> None:
    assert {"deadlock", "scheduler", "mailbox", "control socket"} <= {term for term, _ in TERMS}


DATE = re.compile(r"[^\n]+\n\n20\d\d-\d\d-\d\d(?:, reversed on 20\d\d-\d\d-\d\d)?\. ")
"""How a decision begins: its heading, and the paragraph that opens with its date."""

LABELS = re.compile(r"(?:Cost|Back):")


def decisions() -> list[tuple[int, str]]:
    """Return the number and the text of each decision, in the order of the numbers."""
    texts = [page.read_text(encoding="utf-8") for page in sorted((FOLDER / "decisions").glob("*.md"))]
    found = [
        each for text in texts for each in re.findall(r"^## (\d+)\. (.*?)(?=^## |\Z)", text, re.DOTALL | re.MULTILINE)
    ]
    return sorted((int(number), text) for number, text in found)


def test_decisions_have_numbers_without_a_gap_a_date_and_a_place() -> None:
    numbered = decisions()
    assert [number for number, _ in numbered] == list(range(1, len(numbered) + 1))
    assert len(numbered) > 80
    for number, text in numbered:
        assert DATE.match(text), f"decision {number} does not begin with its date"
        assert places(text), f"decision {number} names no place"
        found = re.findall(r"\*([A-Z][^*]*)\*", text)
        assert all(LABELS.fullmatch(each) for each in found), f"decision {number} has {found}"


def test_every_decisions_page_is_listed() -> None:
    listed = (FOLDER / "decisions" / "README.md").read_text(encoding="utf-8")
    assert all(f"({page.name})" in listed for page in (FOLDER / "decisions").glob("*.md") if page.name != "README.md")


def test_every_unsteady_test_is_there_with_its_date_and_cause() -> None:
    text = (FOLDER / "unsteady.md").read_text(encoding="utf-8")
    rows = [
        [cell.strip() for cell in line.strip("|").split("|")] for line in text.splitlines() if line.startswith("| `")
    ]
    for name, seen, cause in rows:
        file, _, test = name.strip("`").partition("::")
        assert re.fullmatch(r"20\d\d-\d\d-\d\d", seen), name
        if is_of_missing(file):
            continue
        assert f"def {test.partition('[')[0]}(" in (ROOT / file).read_text(encoding="utf-8"), name
        assert cause, name
