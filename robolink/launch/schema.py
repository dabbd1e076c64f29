"""JSON schema of launch files, by which editors complete and check them."""

from __future__ import annotations

from typing import Any

from robolink.documents.json_schema import schema_of
from robolink.launch.reading.description import LaunchDescription

SUBSTITUTION = {"type": "string", "pattern": "[{].*[}]"}
"""Schema of a text with an argument in it, which may stand for any value: `"{speed}"`."""


def launch_schema() -> dict[str, Any]:
    """Return the schema as plain data. Where a number or a choice is wanted, a text with an argument is right, too."""
    schema = schema_of(LaunchDescription, "A launch file of robolink")
    default = {"description": "Value unless another is given; without it one must be given."}
    schema["definitions"]["Argument"]["properties"]["default"] = default
    for part in (schema, *schema["definitions"].values()):
        properties = part.get("properties", {})
        for key, value in properties.items():
            properties[key] = _or_substitution(value)
    return schema


def _or_substitution(value: dict[str, Any]) -> dict[str, Any]:
    if value.get("type") in ("string", "array", "object") and "enum" not in value:
        return value
    if not {"type", "enum", "anyOf"} & set(value):
        return value
    kept = {key: each for key, each in value.items() if key in ("description", "default")}
    inner = {key: each for key, each in value.items() if key not in kept}
    return {**kept, "anyOf": [*inner.pop("anyOf", [inner] if inner else []), SUBSTITUTION]}
