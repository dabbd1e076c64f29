"""Licence files of new packages, by the identifiers of SPDX."""

from __future__ import annotations

import time

from robolink.scaffold.rendering import TEMPLATES, rendered

FOLDER = "licenses"
"""Folder of the texts, one for each identifier."""


def known_licenses() -> list[str]:
    """Return the identifiers of the licences whose text is here, such as MIT."""
    return sorted(each.stem for each in (TEMPLATES / FOLDER).iterdir())


def license_files(identifier: str, holder: str) -> dict[str, str]:
    """Return the file LICENSE of a package by its path; nothing for a licence whose text is not here.

    Args:
        identifier: The licence, as package.xml names it.
        holder: Name of who has the copyright.
    """
    if identifier not in known_licenses():
        return {}
    texts = rendered(FOLDER, {"YEAR": str(time.localtime().tm_year), "HOLDER": holder})
    return {"LICENSE": texts[identifier]}
