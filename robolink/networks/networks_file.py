"""File of networks: names for hosts, and for groups of machines that are peers of each other."""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Mapping
from pathlib import Path

import msgspec

from robolink.documents.mistakes import Step
from robolink.documents.yamlfile import Document, read
from robolink.exceptions import DocumentError, TransportError
from robolink.networks import hosts
from robolink.networks.kinds import OWN
from robolink.networks.limits import Limits, mistakes
from robolink.networks.request import ALIASES, ENDPOINT, NAMES, NetworkRequest
from robolink.system.files import expanded, is_file

FILE = "networks.yaml"
WORKSPACE = "ROBOLINK_WORKSPACE"

_NAME = re.compile(r"[A-Za-z0-9_][A-Za-z0-9_-]*")
FILES = (".json5", ".json", ".yaml", ".yml")
"""Suffixes of Zenoh's files."""


class Peers(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """Machines that are met by name, where multicast does not pass; none of them needs to be on at the start.

    `peers` are their hosts, HOST[:PORT] or tls/HOST[:PORT]. With `lan` everybody on the local network is met as well,
    and this machine may be reached from others. In place of both, `network` is what a name alone may stand for: a host
    or another network. `limits` thin the topics that leave this machine.
    """

    peers: list[str] = []
    lan: bool = False
    network: str = ""
    limits: Limits | None = None


def read_all(environ: Mapping[str, str], origin: str) -> dict[str, str | Peers]:
    """Return the networks of the user's file and the workspace's, by name; the workspace's counts more.

    Args:
        environ: Variables that say where the files are.
        origin: Option or variable to name in an error.

    Raises:
        TransportError: for a mistake in a file, with `file:line:column`.
    """
    found: dict[str, str | Peers] = {}
    for path in places(environ):
        try:
            path.lstat()
        except (FileNotFoundError, NotADirectoryError):
            continue
        except OSError:
            pass  # it cannot be read either, which says why
        try:
            found |= _read(path)
        except DocumentError as error:
            raise TransportError(f"{origin}: {error}") from None
    return found


def limits_of(request: NetworkRequest, environ: Mapping[str, str]) -> Limits | None:
    """Return the limits of a network of the files; None if it has none, or is not there. Raises as `read_all` does."""
    found = read_all(environ, request.origin).get(request.value)
    return found.limits if isinstance(found, Peers) else None


def places(environ: Mapping[str, str]) -> list[Path]:
    """Return where the files of networks may be: the user's own first, then the workspace's."""
    return [each / FILE for each in (_own_folder(environ), _workspace(environ)) if each is not None]


def _own_folder(environ: Mapping[str, str], platform: str = sys.platform) -> Path | None:
    """Return the folder of the user's settings; None where it cannot be known."""
    if platform == "win32":
        given = environ.get("APPDATA", "")
        return Path(given, "robolink") if given else None
    home = environ.get("HOME", "")
    given = environ.get("XDG_CONFIG_HOME", "")
    if given and Path(given).is_absolute():
        return Path(given, "robolink")
    if not home:
        return None
    return Path(home, "Library/Application Support" if platform == "darwin" else ".config", "robolink")


def _workspace(environ: Mapping[str, str]) -> Path | None:
    """Return the workspace that is asked for, else the nearest folder above that has such a file and is the user's."""
    if given := environ.get(WORKSPACE):
        return expanded(given)
    try:
        here = Path.cwd()
    except OSError:  # it has been deleted
        return None
    return next((each for each in (here, *here.parents) if is_file(each / FILE) and _is_own(each)), None)


def passed_over(environ: Mapping[str, str]) -> Path | None:
    """Return the nearest file above that is not read, since others may write it; None if there is none."""
    try:
        here = Path.cwd()
    except OSError:
        return None
    above = (each / FILE for each in (here, *here.parents) if not environ.get(WORKSPACE))
    return next((each for each in above if is_file(each) and not _is_own(each.parent)), None)


def _is_own(folder: Path) -> bool:
    """True if a folder that was merely found is the user's or root's, and nobody else may write there."""
    if sys.platform == "win32":
        return True
    try:
        stats = [folder.stat(), (folder / FILE).stat()]
    except OSError:
        return False
    return all(each.st_uid in (0, os.getuid()) and not each.st_mode & 0o022 for each in stats)


def _read(path: Path) -> dict[str, str | Peers]:
    document = read(path, dict[str, str | Peers])
    for name, meant in document.value.items():
        if name in NAMES or name in ALIASES or name in OWN:
            raise document.error([name], f"'{name}' is the name of another network already", key=True)
        if not _NAME.fullmatch(name):
            raise document.error([name], "a name has letters, digits, _ and - only", key=True)
        _check(document, name, meant)
    return {name: _beside(path, meant) for name, meant in document.value.items()}


def _beside(path: Path, meant: str | Peers) -> str | Peers:
    """Return the meaning of a name; a file of Zenoh's is looked for beside the file of networks."""
    if isinstance(meant, Peers):
        return msgspec.structs.replace(meant, network=str(_beside(path, meant.network))) if meant.network else meant
    return os.fspath(path.parent / meant) if meant.endswith(FILES) else meant


def _check(document: Document[dict[str, str | Peers]], name: str, meant: str | Peers) -> None:
    """Raise DocumentError for what names no network."""
    if isinstance(meant, str):
        _check_way(document, [name], meant)
        return
    if meant.network:
        if meant.peers or meant.lan:
            raise document.error([name, "network"], "either `network`, or `peers` and `lan`", key=True)
        _check_way(document, [name, "network"], meant.network)
    elif not meant.peers:
        raise document.error([name, "peers"], "name at least one host")
    for index, each in enumerate(meant.peers):
        if hosts.parse(each) is None:
            wrong = hosts.mistake(each) or "write HOST or HOST:PORT"
            raise document.error([name, "peers", index], f"'{each[:80]}' is not a host: {wrong}")
        _check_no_name(document, [name, "peers", index], each)
    for steps, message, is_key in mistakes(meant.limits) if meant.limits else ():
        raise document.error([name, "limits", *steps], message, key=is_key)


def _check_way(document: Document[dict[str, str | Peers]], steps: list[Step], meant: str) -> None:
    if meant not in (*NAMES, *ALIASES) and not _is_way(meant):
        wrong = hosts.mistake(meant) or "write HOST[:PORT], tls/HOST[:PORT] or a file (.json5)"
        raise document.error(steps, f"'{meant[:80]}' is not a network: {wrong}")
    _check_no_name(document, steps, meant)


def _check_no_name(document: Document[dict[str, str | Peers]], steps: list[Step], meant: str) -> None:
    if meant in document.value and meant != steps[0]:
        raise document.error(steps, f"'{meant}' is a name of this file itself: write the host that it stands for")


def _is_way(meant: str) -> bool:
    return meant.endswith(FILES) or ENDPOINT.fullmatch(meant) is not None or hosts.parse(meant) is not None
