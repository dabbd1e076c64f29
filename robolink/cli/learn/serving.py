"""Hidden command of the process that checks a student's program."""

from __future__ import annotations

from pathlib import Path

import typer

app = typer.Typer()


@app.command()
def serve(folder: Path, file: Path, language: str, answer: Path) -> None:
    """Check a program in this process, and write the report into a file."""
    from robolink.grading.languages import language_of
    from robolink.learn.checking import serve

    serve(folder, file, answer, language_of(language) or "en")
