"""Files of a bag: found by its metadata.yaml, or by their names where there is none."""

from __future__ import annotations

import re
from pathlib import Path, PureWindowsPath
from typing import NamedTuple

from robolink.bag import zstd
from robolink.bag.metadata import FILE_NAME, BagMetadata, read_metadata
from robolink.bag.storage.opening import ENDINGS
from robolink.bag.topic import BagError
from robolink.documents.yamlfile import siblings
from robolink.exceptions import nearest
from robolink.system.terminal import shown


class Contents(NamedTuple):
    """Files of a bag in their order, its metadata if it has any that can be read, and a line for each problem."""

    files: list[Path]
    metadata: BagMetadata | None
    problems: list[str]


def contents(path: Path, *, ignores_metadata: bool = False) -> Contents:
    """Return the metadata and the files of a bag.

    Args:
        path: The bag's folder, its metadata.yaml, or one storage file.
        ignores_metadata: True to look at the files alone.

    Raises:
        BagError: if there is nothing, or nothing that belongs to a bag.
    """
    if path.name == FILE_NAME and path.is_file():
        path = path.parent
    if path.is_file():
        return Contents([path], None, [])
    if not path.is_dir():
        raise BagError(_missing(path))
    problems: list[str] = []
    metadata = None if ignores_metadata else _metadata(path, problems)
    files = _named(path, metadata, problems) if metadata is not None else []
    files = files or storage_files(path)
    if not files:
        beside = f"metadata.yaml names {len(problems)}, but " if metadata is not None and problems else ""
        raise BagError(f"{path} is not a bag: {beside}there is no .mcap and no .db3 file in it")
    return Contents(files, metadata, problems)


def storage_files(folder: Path) -> list[Path]:
    """Return the storage files in a folder, by the numbers at the ends of their names."""
    try:
        found = [each for each in folder.iterdir() if each.name.endswith(ENDINGS) and not each.name.startswith(".")]
    except OSError as error:
        raise BagError(f"{folder} cannot be read: {error.strerror}") from None
    names = {each.name for each in found}
    single = [each for each in found if each.name.removesuffix(zstd.ENDING) not in names - {each.name}]
    return sorted((each for each in single if each.is_file()), key=_order)


def _metadata(folder: Path, problems: list[str]) -> BagMetadata | None:
    if not (folder / FILE_NAME).exists():
        return None
    try:
        return read_metadata(folder)
    except BagError as error:
        problems.append(f"{error}; 'robolink bag reindex {shown(str(folder))}' makes it anew")
        return None


def _named(folder: Path, metadata: BagMetadata, problems: list[str]) -> list[Path]:
    """Return the files that metadata names and that are there: within the folder, whatever path it says.

    Where one is missing, a file that nobody names may be it: a name is as easily damaged as anything else.
    """
    files = list(dict.fromkeys(_within(folder, each) for each in metadata.relative_file_paths))
    for each in files:
        if not each.is_file():
            problems.append(f"{each} is missing: metadata.yaml names it")
    found = [each for each in files if each.is_file()]
    if found and len(found) < len(files):
        found += [each for each in storage_files(folder) if each not in found]
    return found


def _within(folder: Path, named: str) -> Path:
    """Return the file of a folder that a path in metadata means.

    The path may be of Windows or have a backslash in its name here; and a recorder that was killed may have compressed
    the file without saying so.
    """
    names = [Path(named).name, PureWindowsPath(named).name]
    found = (folder / f"{name}{ending}" for ending in ("", zstd.ENDING) for name in names if name)
    return next((each for each in found if each.is_file()), folder / names[-1])


def _order(path: Path) -> tuple[str, int, str]:
    number = re.fullmatch(r"(.*?)_?([0-9]{1,18})", path.name.partition(".")[0])
    return (number[1], int(number[2]), path.name) if number else (path.name, -1, path.name)


def _missing(path: Path) -> str:
    if path.exists():
        return f"{path} is neither a folder nor a file"
    return f"no bag '{shown(str(path))}'{nearest(path.name, siblings(path))}"
