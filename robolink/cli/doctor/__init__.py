"""robolink doctor: what may be wrong with this machine, its network and the running system."""

from __future__ import annotations

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
        for line in [*([] if report else _lines(verdicts, failed)), *(line for each in shown for line in each.lines())]:
            say(line)
    if failed and not report:
        raise typer.Exit(1)


BY_SYMPTOM = "By what one sees: docs/reference/troubleshooting.md"
"""Last line of what is told where something is not as it should be."""


def _lines(verdicts: list[tuple[Check, Verdict]], failed: list[str]) -> list[str]:
    lines = []
    for check, verdict in verdicts:
        head = f"{MARKS[verdict.level]:6}{check.name:16}"
        first, *others = verdict.findings or [verdict.summary]
        lines += [head + first, *(" " * len(head) + each for each in others)]
    if failed:
        modules = sorted(set(failed))
        lines += [
            f"\n{len(failed)}/{len(verdicts)} check(s) failed\n",
            f"Failed modules: {' '.join(modules)}",
            BY_SYMPTOM,
        ]
        return lines
    levels = [verdict.level for _, verdict in verdicts]
    return [*lines, f"\n{_passed(levels)}\n", *([BY_SYMPTOM] if "warning" in levels else [])]


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
