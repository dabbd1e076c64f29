"""Hidden command of the process that runs one program of a race."""

from __future__ import annotations

from pathlib import Path

import typer

app = typer.Typer()


@app.command()
def serve(name: str, seed: int, program: str, answer: Path) -> None:
    """Run a program in this process, and write the result into a file."""
    from robolink.race.apart import serve

    serve(name, program, seed, answer)
