"""JSON schema, draft 7, of files that Structs describe: the draft that the YAML servers of editors know."""

from __future__ import annotations

import inspect
import json
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
    told = {key: value for key, value in part.items() if key != "default" or _is_telling(value)}
    made = {key: draft_7(value) for key, value in told.items()}
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


def schema_of(kind: type, title: str) -> dict[str, Any]:
    """Return the schema of a file.

    Args:
        kind: Struct of the whole file; the docstrings of the Structs are what editors show.
        title: Title of the schema.
    """
    import msgspec

    _, parts = msgspec.json.schema_components([kind], ref_template="#/definitions/{name}")
    definitions = {name: draft_7(part) for name, part in sorted(parts.items())}
    whole = definitions.pop(kind.__name__)
    return {"$schema": DRAFT, **whole, "title": title, "definitions": definitions}
