"""Blocks of the reference pages, whose own tests run some of them: each command has the words that it needs.

Python blocks compile, YAML blocks can be read. What the pages of docs/en show is run, by test_pages_run.py.
"""

from __future__ import annotations

import ast
import functools
import shlex
from pathlib import Path
from typing import Any

import pytest
import yaml

from robolink.cli.root import command
from tools.docs_site.markdown import Block, blocks
from tools.docs_site.pages import DOCS

PAGES = [*sorted(DOCS.parent.glob("README*.md")), *sorted(DOCS.glob("*.md"))]
BLOCKS = [(page, block) for page in PAGES for block in blocks(page.read_text(encoding="utf-8"))]
SCREENS = {"text", "json5", "console", "sh", "", "html", "js", "json", "xml", "toml", "powershell"}
"""Languages of blocks of which only the commands are looked at."""


def commands(block: Block) -> list[str]:
    """The commands of robolink that a block shows."""
    lines = block.text.replace("\\\n", " ").splitlines()
    if block.language == "console":
        lines = [each.removeprefix("$ ") for each in lines if each.startswith("$ ")]
    return [each for each in lines if each.startswith("robolink ")]


LINES = sorted({line for _, block in BLOCKS if block.language in ("sh", "console") for line in commands(block)})


@functools.cache
def root() -> Any:
    return command()


def problem(line: str) -> str:
    """Return the command line's error about the words of a line; '' if there is none."""
    words = shlex.split(line, comments=True)[1:]
    words = words[
        : next((index for index, each in enumerate(words) if each in ("|", ">", "&&", "&", "||")), len(words))
    ]
    each, name, context = root(), "robolink", None
    try:
        while hasattr(each, "list_commands"):  # with its parent: a command keeps the first names of its help option
            context = each.make_context(name, list(words), parent=context)
            rest = [*getattr(context, "_protected_args", []), *context.args]
            if not rest:
                return ""  # the noun alone does something
            name, each, words = each.resolve_command(context, rest)
        each.make_context(name, list(words), parent=context)
    except Exception as error:  # typer's own errors moved with its copy of click
        if type(error).__name__ in ("Exit", "NoArgsIsHelpError"):
            return ""
        return f"{type(error).__name__}: {getattr(error, 'message', error)}"
    return ""


@pytest.mark.parametrize("line", LINES)
def test_a_command_has_the_words_and_options_of_the_page(
    line: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.chdir(tmp_path)
    assert problem(line) == ""


def test_there_are_many_and_a_wrong_one_is_found() -> None:
    assert len(LINES) > 150
    assert "NoSuchOption" in problem("robolink topic echo /scan --onec")
    assert "No such command" in problem("robolink topic ecko /scan")


@pytest.mark.parametrize(
    "number", range(len(BLOCKS)), ids=lambda number: f"{BLOCKS[number][0].stem}-{BLOCKS[number][1].line}"
)
def test_programs_compile_and_files_can_be_read(number: int) -> None:
    _, block = BLOCKS[number]
    if block.language == "python":
        ast.parse(block.text)
    elif block.language == "yaml":
        list(yaml.safe_load_all(block.text))
    else:
        assert block.language in SCREENS
