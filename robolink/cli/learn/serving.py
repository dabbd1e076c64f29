"""Hidden command of the process that checks a student's program."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

app = typer.Typer()


@app.command()
def serve(folder: Path, file: Path, out: Path, language: Annotated[str, typer.Option("--language")] = "en") -> None:
    """Check a program in this process, and write the report into a file."""
    from robolink.learn.isolated import serve
    from robolink.learn.languages import language_of

    serve(folder, file, out, language_of(language) or "en")
