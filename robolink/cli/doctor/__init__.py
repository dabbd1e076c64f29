"""robolink doctor: what may be wrong with this machine, its network and the running system."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Annotated, Any

import typer

if TYPE_CHECKING:
    from robolink.cli.doctor.facts import Check, Verdict
    from robolink.cli.doctor.report import Section

app = typer.Typer(no_args_is_help=False)

MARKS = {"ok": "ok", "warning": "WARN", "error": "FAIL", "unknown": "?"}


@app.command("doctor")
def doctor(
    report: Annotated[bool, typer.Option("--report", "-r", help="Print all reports instead of the checks.")] = False,
    report_failed: Annotated[
        bool, typer.Option("--report-failed", "-rf", help="Print the reports of failed checks too.")
    ] = False,
    include_warnings: Annotated[
        bool, typer.Option("--include-warnings", "-iw", help="Count warnings as failures.")
    ] = False,
    as_json: Annotated[bool, typer.Option("--json", help="Print a JSON object.")] = False,
) -> None:
    """Check the settings, the network and the running system; the exit code is 1 if a check fails."""
    from robolink.cli.doctor.checks import CHECKS
    from robolink.cli.doctor.dds_checks import DDS_CHECKS
    from robolink.cli.doctor.gathering import gather
    from robolink.cli.doctor.graph_checks import GRAPH_CHECKS
    from robolink.cli.doctor.report import sections
    from robolink.cli.shared.marks import say_styled
    from robolink.cli.shared.output import say

    facts = gather()
    # Where the system could not be looked at, one check says so, and the others have nothing to say.
    checks = CHECKS + DDS_CHECKS + (GRAPH_CHECKS[:1] if facts.seen.error else GRAPH_CHECKS)
    verdicts = [(check, check.decide(facts)) for check in checks]
    bad = ("error", "warning") if include_warnings else ("error",)
    failed = [check.module for check, verdict in verdicts if verdict.level in bad]
    shown = [each for each in sections(facts) if report or (report_failed and each.module in failed)]
    if as_json:
        say(_json(verdicts, failed, shown))
    else:
        for style, mark, line in [] if report else _lines(verdicts, failed):
            say_styled(mark, style, line)
        for line in (line for each in shown for line in each.lines()):
            say(line)
    if failed and not report:
        raise typer.Exit(1)


BY_SYMPTOM = "By what one sees: docs/reference/troubleshooting.md"
"""Last line of what is told where something is not as it should be."""


def _lines(verdicts: list[tuple[Check, Verdict]], failed: list[str]) -> Iterator[tuple[str, str, str]]:
    """Yield the style of each line, what of it is in that style, and the rest."""
    from robolink.cli.shared.marks import BAD, GOOD, WARNING

    styles = {"ok": GOOD, "warning": WARNING, "error": BAD, "unknown": ""}
    for check, verdict in verdicts:
        first, *others = verdict.findings or [verdict.summary]
        mark = MARKS[verdict.level]
        yield styles[verdict.level], mark, f"{'':{6 - len(mark)}}{check.name:16}{first}"
        yield from (("", "", f"{'':22}{each}") for each in others)
    levels = [verdict.level for _, verdict in verdicts]
    yield "", "", ""
    if failed:
        yield BAD, f"{len(failed)}/{len(verdicts)} check(s) failed", "\n"
        yield "", "", f"Failed modules: {' '.join(sorted(set(failed)))}"
    else:
        yield styles[_worst(levels)], _passed(levels), "\n"
    if failed or "warning" in levels:
        yield "", "", BY_SYMPTOM


def _worst(levels: list[str]) -> str:
    return next((each for each in ("warning", "unknown") if each in levels), "ok")


def _passed(levels: list[str]) -> str:
    """Return in words how many checks have passed, and how many not."""
    from robolink.cli.doctor.facts import OK, UNKNOWN, WARNING, count

    if levels.count(OK) == len(levels):
        return f"All {len(levels)} checks passed"
    warnings, unknown = levels.count(WARNING), levels.count(UNKNOWN)
    rest = [count(warnings, "warning")] * bool(warnings) + [f"{unknown} not known"] * bool(unknown)
    return ", ".join([f"{levels.count(OK)} of {len(levels)} checks passed", *rest])


def _json(verdicts: list[tuple[Check, Verdict]], failed: list[str], shown: list[Section]) -> str:
    import msgspec

    from robolink.cli.doctor.facts import OK

    checks = [
        {
            "name": check.name,
            "module": check.module,
            "level": verdict.level,
            "summary": verdict.summary,
            "errors": verdict.errors,
            "warnings": verdict.warnings,
        }
        for check, verdict in verdicts
    ]
    result: dict[str, Any] = {
        "checks": checks,
        "total": len(verdicts),
        "passed": sum(verdict.level == OK for _, verdict in verdicts),
        "failed": len(failed),
        "failed_modules": sorted(set(failed)),
    }
    if shown:
        result["report"] = {each.name: each.items for each in shown}
    return msgspec.json.encode(result).decode()
