"""Every block of every English page is run; the reasons why a few are not are listed here."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.support.domains import free_domain
from tests.support.page_runner import Shells
from tools.docs_site.markdown import blocks
from tools.docs_site.pages import ROOT, Page, pages

SITE = [each for each in pages("en") if each.source is not None]
WRITTEN = [*SITE, Page("en", "README.md", ROOT / "README.md")]
RUN = [each for each in WRITTEN if blocks(each.text())]
REASONS = {
    "installs packages",
    "is for Windows",
    "is for a Raspberry Pi",
    "needs Docker",
    "measures for minutes",
    "needs ROS 2",
    "needs a package of a workspace",
    "needs aiohttp",
    "needs a robot",
    "needs a world of Webots",
    "needs other machines",
    "writes commands beside robolink's",
}
"""Why blocks are not run, over all pages."""


def files_before(page: Page, shells: Shells) -> None:
    """Write the files of the pages before, with which a reader begins: each page of `learn` goes on with them."""
    if not page.address.startswith("learn/"):
        return
    for each in WRITTEN[: WRITTEN.index(page)]:
        for block in blocks(each.text()):
            if block.title and each.address.startswith("learn/") and not block.directive.startswith("not"):
                shells.write(block, block.title)


@pytest.mark.processes
@pytest.mark.slow
@pytest.mark.timeout(180)
@pytest.mark.parametrize("page", RUN, ids=lambda page: page.address)
def test_a_pages_blocks_run(page: Page, tmp_path: Path) -> None:
    with free_domain() as domain, Shells(tmp_path, domain) as shells:
        files_before(page, shells)
        shells.run(page.text())


def test_what_is_not_run_has_one_of_these_reasons() -> None:
    said = [block.directive for page in WRITTEN for block in blocks(page.text()) if block.directive.startswith("not")]
    assert {each.removeprefix("not, ") for each in said} == REASONS
