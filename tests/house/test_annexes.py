"""No other room imports an annex: `python -m tools.without_annex` deletes each, and runs the rest of the tests."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from tools.without_annex import ANNEXES, REGISTRIES, ROOT, modules_of

CODE = [*ROOT.glob("robolink/**/*.py"), *ROOT.glob("nodes/*.py")]


def imported(tree: ast.Module, package: str) -> Iterator[tuple[int, str]]:
    """Yield the names that a file imports, inside functions too, each with its line; and texts that name a module."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from ((node.lineno, each.name) for each in node.names)
        elif isinstance(node, ast.ImportFrom):
            base = package.split(".")[: -node.level + 1 or None] if node.level else []
            module = ".".join([*base, *filter(None, [node.module])])
            yield from ((node.lineno, f"{module}.{each.name}") for each in node.names)
        elif isinstance(node, ast.Constant) and isinstance(node.value, str):
            yield node.lineno, node.value.partition(":")[0]


def is_in(name: str, modules: list[str]) -> bool:
    return any(name == each or name.startswith(f"{each}.") for each in modules)


def lines_that_name(modules: list[str], files: list[Path]) -> list[str]:
    found = []
    names = "|".join(re.escape(each.rpartition(".")[2]) for each in modules)
    hint = re.compile(rf"\.(?:{names})\b|import .*\b(?:{names})\b|^\s+(?:{names}),$", re.MULTILINE)
    for file in files:
        own = ".".join(file.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__")
        if str(file.relative_to(ROOT)) in REGISTRIES or is_in(own, modules):
            continue
        package = own if file.name == "__init__.py" else own.rpartition(".")[0]
        text = file.read_text(encoding="utf-8")
        if hint.search(text):  # most files need not be parsed
            found += [
                f"{file.relative_to(ROOT)}:{line}: {name}"
                for line, name in imported(ast.parse(text), package)
                if is_in(name, modules)
            ]
    return found


@pytest.mark.parametrize("annex", ANNEXES)
def test_no_other_room_imports_an_annex(annex: str) -> None:
    assert lines_that_name(modules_of(annex), CODE) == []


def test_a_file_that_imports_a_room_is_found() -> None:
    assert lines_that_name(["robolink.tf2"], [*ROOT.glob("robolink/cli/tf/*.py")])
    assert lines_that_name(["robolink.workspace"], [ROOT / "robolink/cli/pkg.py"])


def test_late_and_relative_imports_and_names_in_texts_are_found() -> None:
    text = "def f():\n    from .. import view\n    import robolink.view.server\nX = 'robolink.view:page_of'\n"
    found = sorted(imported(ast.parse(text), "robolink.cli.shared"))
    assert found == [(2, "robolink.cli.view"), (3, "robolink.view.server"), (4, "robolink.view")]


@pytest.mark.annex(*ANNEXES)  # some files belong to two of them
@pytest.mark.parametrize("annex", ANNEXES)
def test_the_patterns_of_an_annex_lead_to_files(annex: str) -> None:
    assert [each for each in ANNEXES[annex] if not any(ROOT.glob(each))] == []
    assert modules_of(annex)
