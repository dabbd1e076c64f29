"""Option --schema of `launch` and `simulate`: prints the JSON schema of launch files and of faults files."""

from __future__ import annotations

import typer

from robolink.cli.shared.output import say


def show_launch_schema(asked: bool) -> None:
    """Print the schema of launch files, if that is asked, and end."""
    if asked:
        from robolink.documents.json_schema import text_of
        from robolink.launch.reading.description import launch_schema

        say(text_of(launch_schema()).removesuffix("\n"))
        raise typer.Exit


def show_faults_schema(asked: bool) -> None:
    """Print the schema of faults files, if that is asked, and end."""
    if asked:
        from robolink.documents.json_schema import text_of
        from robolink.faults.file import faults_schema

        say(text_of(faults_schema()).removesuffix("\n"))
        raise typer.Exit
