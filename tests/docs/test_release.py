"""Release: one version everywhere, a long description without relative links, extras, lowest versions."""

from __future__ import annotations

import re
import runpy
from datetime import date
from pathlib import Path
from typing import Any

import pytest

from robolink.documents.yamlfile import parse

ROOT = Path(__file__).parents[2]
PYPROJECT = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
README = (ROOT / "README.md").read_text(encoding="utf-8")
RELEASE = runpy.run_path(str(ROOT / "tools" / "release.py"))
LOWEST = runpy.run_path(str(ROOT / "tools" / "lowest.py"))


def described() -> str:
    """The README as hatch-fancy-pypi-readme changes it by pyproject.toml."""
    text = README
    pairs = re.findall(r"^pattern = '(.*)'\nreplacement = '(.*)'$", PYPROJECT, re.MULTILINE)
    assert len(pairs) == 2
    for pattern, replacement in pairs:
        text = re.sub(pattern, replacement, text)
    return text


def test_the_long_description_has_no_relative_links() -> None:
    assert re.search(r"\]\((?!https?://)", README)  # or this test proves nothing
    text = described()
    assert re.findall(r"\]\((?!https?://)[^)]*\)", text) == []
    assert "docs/reference/testing.md has the rest" in text
    assert re.findall(r"\]\(https://[^)]+\)", text) == re.findall(r"\]\(https://[^)]+\)", README)


def test_version_citation_and_changelog_are_checked_against_the_tag(tmp_path: Path) -> None:
    (tmp_path / "pyproject.toml").write_text('[project]\nversion = "1.2.0"\n')
    (tmp_path / "CITATION.cff").write_text("version: 1.2.0\n")
    changelog = tmp_path / "CHANGELOG.md"
    changelog.write_text(
        "# Changelog\n\n## 1.3.0 (2031-01-01)\n\n- x\n\n## 1.2.0 (2030-01-01)\n\n- y\n\n## 1.1.0\n\n- z\n"
    )
    assert RELEASE["notes"]("v1.2.0", tmp_path) == "- y\n"
    with pytest.raises(ValueError, match=r"pyproject.toml: the version is 1.2.0, the tag is v1.3.0"):
        RELEASE["notes"]("v1.3.0", tmp_path)
    changelog.write_text("# Changelog\n")
    with pytest.raises(ValueError, match=r"CHANGELOG.md: no section '## 1.2.0'"):
        RELEASE["notes"]("v1.2.0", tmp_path)
    (tmp_path / "CITATION.cff").write_text("version: 1.1.0\n")
    with pytest.raises(ValueError, match=r"CITATION.cff: the version is 1.1.0"):
        RELEASE["notes"]("v1.2.0", tmp_path)


def test_a_section_that_says_something_twice_is_no_release(tmp_path: Path) -> None:
    (tmp_path / "pyproject.toml").write_text('[project]\nversion = "1.2.0"\n')
    (tmp_path / "CITATION.cff").write_text("version: 1.2.0\n")
    changelog = tmp_path / "CHANGELOG.md"
    for text, word in (("### New\n\n- x\n\n### New\n\n- y\n", "New"), ("- a:\n  - x\n- b:\n  - x\n", "x")):
        changelog.write_text(f"# Changelog\n\n## 1.2.0 (2030-01-01)\n\n{text}")
        with pytest.raises(ValueError, match=f"'{word}' stands twice in the section of 1.2.0"):
            RELEASE["notes"]("v1.2.0", tmp_path)


def test_fragments_are_collected_into_a_section_by_their_kinds(tmp_path: Path) -> None:
    (tmp_path / "changes").mkdir()
    changelog = tmp_path / "CHANGELOG.md"
    changelog.write_text("# Changelog\n\nWords.\n\n## 1.2.0 (2030-01-01)\n\n- y\n")
    (tmp_path / "changes" / "README.md").write_text("How to.\n")
    with pytest.raises(ValueError, match="changes/ has no fragments"):
        RELEASE["collect"]("1.3.0", date(2031, 2, 3), tmp_path)
    (tmp_path / "changes" / "a.md").write_text("- **Fixed**: a.\n- **Added**: b,\n  on two lines:\n  - c\n")
    (tmp_path / "changes" / "b.md").write_text("- **Changed**: d.\n")
    RELEASE["collect"]("1.3.0", date(2031, 2, 3), tmp_path)
    assert changelog.read_text() == (
        "# Changelog\n\nWords.\n\n## 1.3.0 (2031-02-03)\n\n- **Added**: b,\n  on two lines:\n  - c\n- **Changed**: d.\n"
        "- **Fixed**: a.\n\n## 1.2.0 (2030-01-01)\n\n- y\n"
    )
    assert [each.name for each in (tmp_path / "changes").iterdir()] == ["README.md"]


@pytest.mark.parametrize("text", ["", "Words.\n", "- Fixed: a\n", "- **Mended**: a\n", "Words.\n\n- **Fixed**: a\n"])
def test_a_fragment_without_a_kind_is_refused_by_its_name(text: str, tmp_path: Path) -> None:
    (tmp_path / "changes").mkdir()
    (tmp_path / "changes" / "a.md").write_text(text)
    with pytest.raises(ValueError, match=r"changes/a.md: an entry begins with '- ', then one of \*\*Added"):
        RELEASE["entries"](tmp_path)


def test_the_fragments_of_now_can_be_collected() -> None:
    assert len(RELEASE["entries"]()) >= len(RELEASE["fragments"]())


def test_the_changelog_has_a_section_for_the_version() -> None:
    version = RELEASE["VERSION"].search(PYPROJECT)
    assert version is not None
    text = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    title = re.findall(r"^## (.*)$", text, re.MULTILINE)[0]
    assert re.fullmatch(re.escape(version[1]) + r" \(\d{4}-\d\d-\d\d\)", title)
    summary = text.partition(f"## {title}\n")[2].partition("\n### ")[0]
    assert 5 <= summary.count("\n- ") <= 12


def test_the_citation_has_the_version_of_the_project() -> None:
    version = RELEASE["VERSION"].search(PYPROJECT)
    cited: Any = parse((ROOT / "CITATION.cff").read_text(encoding="utf-8"))
    assert version is not None
    assert str(cited["version"]) == version[1]
    assert {"cff-version", "message", "title", "authors"} <= set(cited)


def test_all_is_every_extra_that_users_install() -> None:
    extras = re.findall(
        r"^(\w+) = \[", PYPROJECT.partition("[project.optional-dependencies]")[2].partition("\n[")[0], re.MULTILINE
    )
    assert sorted(extras) == sorted([*LOWEST["USERS"], "all"])
    assert f'all = ["robolink[{",".join(sorted(LOWEST["USERS"]))}]"]' in PYPROJECT


def test_every_dependency_has_a_lowest_version() -> None:
    block = PYPROJECT.partition("\ndependencies = [")[2].partition("\n]")[0]
    names = re.findall(r'^    "([\w.-]+)', block, re.MULTILINE)
    assert len(names) > 8
    constraints = list(LOWEST["lowest"](PYPROJECT))
    assert [each.partition("==")[0] for each in constraints[: len(names)]] == names
    assert all(re.fullmatch(r"[\w.-]+==\d[\w.]*", each) for each in constraints)
    (opencv,) = (each for each in constraints if each.startswith("opencv-python=="))
    assert opencv.replace("==", "-headless==") in constraints


def test_the_sdist_has_the_files_of_the_root_and_not_those_of_the_same_name_elsewhere() -> None:
    (included,) = re.findall(r"^include = \[(.*)\]$", PYPROJECT, re.MULTILINE)
    paths = [each.strip(' "') for each in included.split(",")]
    assert len(paths) > 8
    assert [each for each in paths if not each.startswith("/") or not (ROOT / each[1:]).exists()] == []
