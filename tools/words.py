"""Count of the words that this project no longer uses, by room: in names, docstrings, help texts and messages.

Usage: python -m tools.words                     count of each room, and the files that have most
       python -m tools.words ROOM_OR_FILE ...    each place of these rooms (robolink/bag, nodes) or files
"""

from __future__ import annotations

import ast
import io
import re
import sys
import tokenize
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).parents[1]
FOLDERS = ("robolink", "nodes", "tools", "benchmarks")
"""Folders of Python code that are counted; tests are not."""
OLD = {
    "asked": "requested, or the thing itself",
    "wanted": "expected or requested",
    "told": "given or reported",
    "kept": "stored, saved or retained",
    "wish": "request",
    "wishes": "requests",
    "wished": "requested",
    "manner": "mode or style",
    "manners": "modes or styles",
}
"""Words that no name is made of, each with the field's word."""
_PARTS = re.compile(r"[A-Z]?[a-z]+|[A-Z]+(?![a-z])")
_IS_NO = re.compile(
    r"(?<!\bthere )\b(?:is|are|was|were) no (?!longer\b|more\b|less\b|one\b|other\b)[`'\"{]?[\w}]+", re.IGNORECASE
)
_DOCSTRING = re.compile(
    r"(?:Return|Returns|Yield|Print|Write|Say|Tell) (?:what|whom|who)\b|(?:Give|Tell|What|Whether)\b"
)
_HELP = re.compile(r"(?:Of|So many|What|Whom|Whether|That|How)\b")
_HELPED = {"Option", "Argument", "Entry"}
"""Calls whose first sentence of help is shown on the command line."""


class Place(NamedTuple):
    """Place of an old word: the file, its line, the kind (name, docstring, text, help) and the word in its context."""

    file: str
    line: int
    kind: str
    text: str

    @property
    def room(self) -> str:
        """Room of the file: `robolink/bag`, `nodes`; a module in the root of the package is a room of its own."""
        parts = self.file.split("/")
        return "/".join(parts[:2]) if parts[0] == "robolink" else parts[0]


def old_words(name: str) -> list[str]:
    """Return the old words that an identifier consists of: `_is_asked` has one, `masked` none."""
    return [part for part in map(str.lower, _PARTS.findall(name)) if part in OLD]


def places(path: Path, root: Path = ROOT) -> list[Place]:
    """Return the places of old words in a file, by line. A name counts once, where the file first binds it."""
    source = path.read_text(encoding="utf-8")
    file = path.relative_to(root).as_posix()
    tree = ast.parse(source)
    names = {name: line for line, name in sorted(_bound(tree), reverse=True) if old_words(name)}
    if old_words(path.stem):
        names[path.name] = 1
    found = [Place(file, line, "name", name) for name, line in names.items()]
    found += [Place(file, line, "docstring", text) for line, text in _docstrings(tree) if _DOCSTRING.match(text)]
    found += [Place(file, line, "help", text) for line, text in _helps(tree) if _HELP.match(text)]
    found += [
        Place(file, line, "text", match[0]) for line, text in _texts(source, tree) for match in _IS_NO.finditer(text)
    ]
    return sorted(found, key=lambda each: (each.line, each.kind, each.text))


def _bound(tree: ast.AST) -> Iterator[tuple[int, str]]:
    """Yield the names that a file itself binds: definitions, arguments, variables, attributes and `import as`."""
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
            yield node.lineno, node.name
        elif isinstance(node, ast.arg):
            yield node.lineno, node.arg
        elif isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
            yield node.lineno, node.id
        elif isinstance(node, ast.Attribute) and isinstance(node.ctx, ast.Store):
            yield node.lineno, node.attr
        elif isinstance(node, ast.alias) and node.asname:
            yield node.lineno, node.asname


def _docstrings(tree: ast.AST) -> Iterator[tuple[int, str]]:
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef | ast.Module):
            text = ast.get_docstring(node)
            if text:
                yield node.body[0].lineno, text.partition("\n")[0]


def _helps(tree: ast.AST) -> Iterator[tuple[int, str]]:
    for node in ast.walk(tree):
        if not isinstance(node, ast.Call) or getattr(node.func, "attr", getattr(node.func, "id", "")) not in _HELPED:
            continue
        for each in node.keywords:
            if each.arg == "help" and isinstance(each.value, ast.Constant) and isinstance(each.value.value, str):
                yield each.value.lineno, each.value.value


def _texts(source: str, tree: ast.AST) -> Iterator[tuple[int, str]]:
    """Yield the strings and comments of a file, each with its line."""
    of_formatted = {id(part) for node in ast.walk(tree) if isinstance(node, ast.JoinedStr) for part in node.values}
    for node in ast.walk(tree):
        if isinstance(node, ast.JoinedStr):
            parts = [part.value if isinstance(part, ast.Constant) else "{}" for part in node.values]
            yield node.lineno, " ".join("".join(map(str, parts)).split())
        elif isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in of_formatted:
            yield node.lineno, " ".join(node.value.split())
    for token in tokenize.generate_tokens(io.StringIO(source).readline):
        if token.type == tokenize.COMMENT:
            yield token.start[0], token.string


def files(root: Path = ROOT) -> Iterator[Path]:
    """Yield the files that are counted."""
    for folder in FOLDERS:
        yield from sorted((root / folder).rglob("*.py"))


def counts() -> Counter[str]:
    """Return the number of old words in each room that has any."""
    return Counter(place.room for path in files() for place in places(path))


def main(words: list[str]) -> int:
    """Print the places of some rooms, or the rooms and the files that have most."""
    found = [place for path in files() for place in places(path)]
    if words:
        chosen = [
            each for each in found if any(each.file == word or each.file.startswith(f"{word}/") for word in words)
        ]
        lines = [f"{each.file}:{each.line}: {each.kind}: {each.text}" for each in chosen]
    else:
        lines = [f"{count:5} {room}" for room, count in Counter(each.room for each in found).most_common()]
        lines += ["", *(f"{count:5} {file}" for file, count in Counter(each.file for each in found).most_common(30))]
        lines += ["", *(f"{count:5} {kind}" for kind, count in Counter(each.kind for each in found).most_common())]
        lines += [f"{len(found):5} in all"]
    sys.stdout.write("\n".join(lines) + "\n")
    return 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
