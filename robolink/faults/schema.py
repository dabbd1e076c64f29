"""JSON schema of faults files, by which editors complete and check them."""

from __future__ import annotations

from typing import Any

from robolink.documents.json_schema import schema_of
from robolink.faults.description import FaultsDescription


def faults_schema() -> dict[str, Any]:
    """Return the schema as plain data."""
    return schema_of(FaultsDescription, "Faults of robolink simulate")
