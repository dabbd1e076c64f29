"""Licence files of new packages: the texts that everybody has, with year and holder."""

from __future__ import annotations

import re
import time
from pathlib import Path

import pytest

from robolink.scaffold.packages import known_licenses, license_files


def words(text: str) -> str:
    """Return a licence's text without its title, its line of the copyright, and its breaks."""
    kept = [each for each in text.splitlines() if not re.match(r"(MIT|BSD|Copyright) ", each)]
    return " ".join(" ".join(kept).split())


@pytest.mark.parametrize("identifier", [each for each in known_licenses() if each != "MIT-0"])
def test_the_text_is_that_of_others(identifier: str) -> None:
    others = pytest.importorskip("identify.vendor.licenses")
    (text,) = license_files(identifier, "Ada").values()
    assert words(text) == words(dict(others.LICENSES)[identifier])


def test_mit_0_is_mit_without_its_condition() -> None:
    condition = r", subject to the following conditions: The above .* portions of the Software\."
    texts = [words(license_files(each, "Ada")["LICENSE"]) for each in ("MIT", "MIT-0")]
    assert texts[1] == re.sub(condition, ".", texts[0])
    assert len(texts[1]) < len(texts[0])


def test_apache_s_is_this_project_s_own() -> None:
    own = (Path(__file__).parents[2] / "LICENSE").read_text(encoding="utf-8")
    assert license_files("Apache-2.0", "Ada") == {"LICENSE": own}


@pytest.mark.parametrize("identifier", ["MIT", "MIT-0", "BSD-2-Clause", "BSD-3-Clause"])
def test_year_and_holder_are_in_it(identifier: str) -> None:
    (text,) = license_files(identifier, "Ada Lovelace").values()
    assert re.search(rf"^Copyright (\(c\) )?{time.localtime().tm_year},? Ada Lovelace$", text, re.MULTILINE)
    assert not re.search(r"[@\[\]<>]", text)


def test_others_have_no_file() -> None:
    assert license_files("GPL-3.0-only", "Ada") == license_files("../node/nodes/x", "Ada") == {}
