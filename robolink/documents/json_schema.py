"""JSON schema, draft 7, of files that Structs describe: the draft that the YAML servers of editors know."""

from __future__ import annotations

import inspect
import json
from collections.abc import Mapping
from typing import Any

DRAFT = "http://json-schema.org/draft-07/schema#"
"""Address of the draft, for the key `$schema`."""


def draft_7(part: Any) -> Any:
    """Convert a part of a schema that msgspec has made: pairs, keys beside a reference, and docstrings.

    Args:
        part: Schema of a later draft, or any part of it.
    """
    if isinstance(part, list):
        return [draft_7(each) for each in part]
    if not isinstance(part, dict):
        return part
    telling = {key: value for key, value in part.items() if key != "default" or _is_telling(value)}
    made = {key: draft_7(value) for key, value in telling.items()}
    if isinstance(made.get("description"), str):
        made["description"] = inspect.cleandoc(made["description"]).partition("\n\nArgs:")[0]  # keys say their own
    if isinstance(made.get("anyOf"), list):  # the order is that of no version of msgspec
        made["anyOf"].sort(key=lambda each: each == {"type": "null"})
    if "prefixItems" in made:
        made["items"], made["additionalItems"] = made.pop("prefixItems"), False
    if "$ref" in made and len(made) > 1:
        made["allOf"] = [{"$ref": made.pop("$ref")}]
    return made


def _is_telling(default: Any) -> bool:
    """True if a default helps a writer: those of whole parts only say that they may be left out."""
    return default is not None and default != [] and not isinstance(default, dict)


def text_of(schema: dict[str, Any]) -> str:
    """Return a schema as the text of a file."""
    return json.dumps(schema, indent=2, ensure_ascii=False) + "\n"


def described(name: str, part: dict[str, Any], meanings: Mapping[str, str]) -> dict[str, Any]:
    """Add the description of each key of a Struct, which editors show, and return the Struct's schema.

    Args:
        name: The Struct's name.
        part: Its schema, as `draft_7` returns it.
        meanings: Descriptions by Struct and key, as "Respawn.delay", or by a key that means the same everywhere.

    Raises:
        LookupError: If a key has none.
    """
    for key, schema in part.get("properties", {}).items():
        meaning = schema.get("description") or meanings.get(f"{name}.{key}") or meanings.get(key)
        if meaning is None:
            raise LookupError(
                f"{name}.{key} has no description for editors: give it Annotated[..., Meta(description=...)]"
            )
        schema["description"] = meaning
        if "$ref" in schema:
            schema["allOf"] = [{"$ref": schema.pop("$ref")}]
    return part


def schema_of(kind: type, title: str, meanings: Mapping[str, str]) -> dict[str, Any]:
    """Return the schema of a file.

    Args:
        kind: Struct of the whole file; the docstrings of the Structs are what editors show.
        title: Title of the schema.
        meanings: Descriptions of the keys; see `described`.
    """
    import msgspec

    _, parts = msgspec.json.schema_components([kind], ref_template="#/definitions/{name}")
    definitions = {name: described(name, draft_7(part), meanings) for name, part in sorted(parts.items())}
    whole = definitions.pop(kind.__name__)
    return {"$schema": DRAFT, **whole, "title": title, "definitions": definitions}
