"""PROTOs of Webots: reusable nodes from `.proto` files beside a world, from Webots' folder, or from this one's own few.

Nothing is fetched. A definition whose body is a program (a template in JavaScript or Lua) is not run.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Collection, Mapping
from pathlib import Path
from typing import NamedTuple

from robolink.documents import yamlfile
from robolink.sim.webots.vrml_node import LONGEST, Field, Node, Notes, Source
from robolink.system.terminal import shown

OWN = Path(__file__).parent / "protos"
"""Folder of robots that worlds often have, each as Webots defines it, without what only the eye sees."""

VERSIONS = {("E-puck", "2"): "E-puck2"}
"""Own definitions for a `version` other than the first."""

MOST_WORK = 3_000_000
"""Most words that are read of all PROTOs of a world, each as often as it is used."""

_WEBOTS = re.compile(r"(?:webots://|https?://raw\.githubusercontent\.com/cyberbotics/webots/[^/]+/)(projects/.+)")
_TEMPLATE = re.compile(r"%[<{]")


class Scope(NamedTuple):
    """File that names PROTOs: its folder, and the address of each PROTO that it declares."""

    folder: Path
    addresses: dict[str, str]

    def declare(self, address: str) -> None:
        """Take note of `EXTERNPROTO "address"`: a PROTO is named as its file."""
        self.addresses[address.replace("\\", "/").rpartition("/")[2].removesuffix(".proto")] = address


class Definition(NamedTuple):
    """PROTO: its fields with their defaults, and where its body begins in its file."""

    name: str
    fields: Mapping[str, Field]
    source: Source
    body: int
    scope: Scope


class Protos:
    """Finder of the PROTOs of a world.

    Args:
        notes: Where to tell of fields that a PROTO does not have.
        known: Types of nodes that need no definition, unless one lies beside the world.
        parse: Parser of a PROTO's file, `vrml.parse_proto`, which finds the PROTOs of its own nodes here.
    """

    def __init__(
        self, notes: Notes, known: Collection[str], parse: Callable[[Source, Scope, Protos], Definition]
    ) -> None:
        self.notes, self._parse = notes, parse
        self.missing: dict[str, str] = {}
        """Why PROTOs are not read, by their names."""
        self.work = 0
        self._known = known
        self._own = frozenset(each.stem for each in OWN.glob("*.proto"))
        self._read: dict[Path, Definition | None] = {}
        self._places: dict[tuple[Path, str], Path | None] = {}

    def find(self, node: Node, scope: Scope) -> Definition | None:
        """Return the definition of a node's type; None if it has none that can be read.

        Raises:
            DocumentError: for a mistake in the PROTO's file.
        """
        beside = self._beside(node.type, scope)
        if beside is not None:
            return self._definition(beside, node.type)
        if node.type in self._known:
            return None
        version = node.text("version") if any(kind == node.type for kind, _ in VERSIONS) else ""
        if (own := VERSIONS.get((node.type, version), node.type)) in self._own:
            return self._definition(OWN / f"{own}.proto", node.type)
        address = scope.addresses.get(node.type, "")
        if path := _in_webots(address):
            return self._definition(path, node.type)
        if "/robots/" in address:
            first = sorted(self._own - set(VERSIONS.values()))
            self.missing.setdefault(node.type, f"robots are known by name ({', '.join(first)}) or by their .proto file")
        return None

    def spend(self, words: int, node: Node) -> None:
        """Count words that were read for a node. Raises DocumentError if they are too many."""
        self.work += words
        if self.work > MOST_WORK:
            raise node.error(f"the PROTOs of this world have more than {MOST_WORK:,} words")

    def _beside(self, kind: str, scope: Scope) -> Path | None:
        """Return the file of a PROTO beside a file that names it: where it says, or in the folder `protos`."""
        if (scope.folder, kind) not in self._places:
            self._places[scope.folder, kind] = self._place(kind, scope)
        return self._places[scope.folder, kind]

    def _place(self, kind: str, scope: Scope) -> Path | None:
        address = scope.addresses.get(kind, "")
        if address and "://" not in address:
            path = scope.folder / address
            if address.endswith(".proto") and path.is_file():
                return path
            self.missing[kind] = f"the file '{shown(address, 60)}' is missing"
        elif kind not in self._known and re.fullmatch(r"[\w.-]+", kind):
            places = (scope.folder / f"{kind}.proto", scope.folder.parent / "protos" / f"{kind}.proto")
            return next((each for each in places if each.is_file()), None)
        return None

    def _definition(self, path: Path, kind: str) -> Definition | None:
        if path not in self._read:
            source = Source(yamlfile.read_text(path, LONGEST), os.fspath(path), self.notes)
            if _TEMPLATE.search(source.text):
                self.missing[kind] = "its definition is a program, which is not run"
                self._read[path] = None
            else:
                self._read[path] = self._parse(source, Scope(path.parent, {}), self)
        return self._read[path]


def _in_webots(address: str) -> Path | None:
    """Return the file of Webots' own PROTO in the folder $WEBOTS_HOME."""
    match, home = _WEBOTS.fullmatch(address), os.environ.get("WEBOTS_HOME", "")
    if match is None or not home or ".." in match[1]:
        return None
    places = (Path(home) / match[1], Path(home) / "Contents" / match[1])
    return next((each for each in places if each.is_file()), None)
