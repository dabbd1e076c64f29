"""Writer of the stubs of the standard types, by which type checkers and editors know robolink.interfaces.

python tools/interface_stubs.py            writes robolink/interfaces/PACKAGE/{msg,srv,action}/__init__.pyi
python tools/interface_stubs.py --check    exit code 1 if one is out of date

Writes robolink/interfaces/type_hashes.txt as well, from which a node takes the hashes of these types when it starts.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

from robolink.interfaces import find, standard
from robolink.interfaces.standard import KINDS, ROOT, packages, types_of
from robolink.message import type_name
from robolink.message.description import described, hash_of
from robolink.message.numbers import has_fixed_numbers
from robolink.message.stub import stub_of

FOLDER, HASHES = Path(standard.FOLDER), Path(standard.HASHES)
HEAD = "# Made of the files beside it by tools/interface_stubs.py.\n"


def stubs() -> dict[Path, str]:
    """Return the text of each stub by its path."""
    found = {
        FOLDER / package / kind / "__init__.pyi": HEAD
        + stub_of([find(f"{package}/{kind}/{each}", kind) for each in types_of(package, kind)], kind, f"{ROOT}.")
        for package in packages()
        for kind in KINDS
        if types_of(package, kind)
    }
    return {**found, HASHES: type_hashes()}


def type_hashes() -> str:
    """Return the text of the file of hashes: each type's name and hash, and `numpy` where its endpoints import that."""
    types = [
        find(f"{package}/{kind}/{each}", kind)
        for package in packages()
        for kind in KINDS
        for each in types_of(package, kind)
    ]
    lines = (f"{type_name(each)} {hash_of(described(each))}{' numpy' if _needs_numpy(each) else ''}" for each in types)
    return "\n".join([HEAD.rstrip("\n"), *lines, ""])


def _needs_numpy(cls: Any) -> bool:
    names = ("Request", "Response", "Goal", "Result", "Feedback")
    parts = [cls] if hasattr(cls, "__ros_fields__") else [getattr(cls, each) for each in names if hasattr(cls, each)]
    return any(map(has_fixed_numbers, parts))


def stale(written: dict[Path, str]) -> list[Path]:
    """Return the stubs that are out of date, or of types that are gone."""
    there = {*FOLDER.rglob("*.pyi"), *HASHES.parent.glob(HASHES.name)}
    changed = [path for path, text in written.items() if path not in there or path.read_text(encoding="utf-8") != text]
    return [*changed, *sorted(there - set(written))]


def main(words: list[str]) -> int:
    """Write the stubs, or with `--check` compare them; return the exit code."""
    written = stubs()
    changed = stale(written)
    for path in changed:
        if words == ["--check"]:
            sys.stderr.write(f"{path} is out of date: python tools/interface_stubs.py\n")
        elif path in written:
            path.write_text(written[path], encoding="utf-8", newline="\n")
        else:
            path.unlink()
    return int(words == ["--check"] and bool(changed))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
