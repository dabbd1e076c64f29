"""Tables of the pages, from the file of the benchmark of record: what stands between two marks of a page is written.

A mark is `<!-- record: NAME -->`, with a name of `BLOCKS`; the block ends at `<!-- record ends -->`.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from benchmarks.record.players import PLAYERS
from benchmarks.record.rows import ROWS

Found = Mapping[str, Any]
"""Content of the file."""

PAGES = ("README.md", "README.pt-BR.md", "docs/reference/performance.md", "benchmarks/notes/record.md")
DASH = "\N{EN DASH}"
TITLES = {each.name: each.title for each in PLAYERS}
PORTUGUESE = {"bare": "Zenoh puro", "build": "outra versão"}
TRIPS = ("twist", "scan", "1mb", "6mb")
FLOODS = ("rate-1mb", "flood-10", "flood-1000", "flood-all")
COSTS = ("beat", "start", "start/used", "memory", "fifty")
OURS = ("hour", "follow")
README = ("twist", "scan", "1mb", "6mb", "rate-1mb", "flood-10", "beat", "start", "memory")
LEAST_PLAYERS = ("robolink", "rclpy", "bare", "sdk", "dora")
"""Columns of the README."""
LEAST_LOST = 0.005
"""Share of what was sent whose loss is said."""
_BLOCK = re.compile(r"(<!-- record: ([\w-]+) -->\n).*?(<!-- record ends -->)", re.DOTALL)


def shown(figure: float, unit: str) -> str:
    """Return a figure with its unit, with as many digits as mean something."""
    if unit == "us":
        return f"{figure:.0f} us" if figure < 1000 else f"{rounded(figure / 1000)} ms"
    if unit == "/s":
        return f"{float(f'{figure:.3g}'):,.0f}"
    if unit == "%":
        return f"{rounded(100 * figure)} %"
    return f"{rounded(figure)} {unit}"


def rounded(figure: float) -> str:
    """Return two digits behind the point below ten, and fewer above."""
    return f"{figure:.{2 if figure < 9.995 else 1 if figure < 99.95 else 0}f}"


def cells(found: Found, row: str, players: Sequence[str], *, ratios: bool) -> list[str]:
    """Return the figures of a row, each with how many times robolink's it is; a dash where there is none."""
    medians = found["medians"].get(row, {})
    own = medians.get("robolink")
    words = []
    for player in players:
        if player not in medians:
            words.append(DASH)
            continue
        text = shown(medians[player], ROWS[row].unit)
        if ratios and own and player != "robolink":
            text += f" ({medians[player] / own:.2f})"
        lost = found["medians"].get(f"{row}/lost", {}).get(player, 0.0)
        if ratios and lost >= LEAST_LOST:
            text += f", {lost:.0%} lost"
        words.append(text)
    return words


def table(head: Sequence[str], body: Sequence[Sequence[str]]) -> str:
    lines = [f"| {' | '.join(row)} |".replace("|  |", "| |") for row in (head, ["---"] * len(head), *body)]
    lines[1] = "|" + "---|" * len(head)
    return "\n".join(lines) + "\n"


def players_of(found: Found, rows: Sequence[str], without: Sequence[str] = ()) -> list[str]:
    """Return those who have a figure in one of these rows."""
    there = {player for row in rows for player in found["medians"].get(row, {})}
    return [name for name in TITLES if name in there and name not in without]


def comparison(rows: Sequence[str]) -> Callable[[Found], str]:
    """Return the maker of these rows' table: medians, and in brackets their ratio to robolink's."""

    def made(found: Found) -> str:
        measured = [row for row in rows if row in found["medians"]]
        players = players_of(found, measured, without=["build"])
        head = ["", *(TITLES[name] for name in players)]
        return table(head, [[ROWS[row].english, *cells(found, row, players, ratios=True)] for row in measured])

    return made


def disorder(found: Found) -> str:
    """Return the sentence behind the floods: whose messages came out of order, twice or changed, and how many."""
    said = []
    for player in players_of(found, FLOODS, without=["build"]):
        wrong = sum(sum(found["rows"].get(f"{row}/wrong", {}).get(player, [])) for row in FLOODS)
        if wrong:
            said.append(f"{wrong:.0f} of {TITLES[player]}'s")
    return f"\nOut of order, twice or changed, in all rounds: {', '.join(said) or 'none'}.\n"


def floods(found: Found) -> str:
    return comparison(FLOODS)(found) + disorder(found)


def alone(found: Found) -> str:
    """Return the list of robolink's own rows, over its other build where that played."""
    body = [[ROWS[row].english, *cells(found, row, ["robolink"], ratios=False)] for row in OURS]
    return table(["processor time", "robolink"], body)


def conditions(found: Found) -> str:
    """Return where, when and with what was measured."""
    machine, rounds = found["machine"], max(len(each) for row in found["rows"].values() for each in row.values())
    versions = {
        TITLES[name]: ", ".join(f"{key} {value}" for key, value in each.items() if key not in ("python", "commit"))
        for name, each in found["versions"].items()
        if name != "build"
    }
    turns = "rounds by turns" if rounds > 1 else "round"
    where = f"on {machine['cores']} cores ({machine['processor']}), {machine['system']}, Python {machine['python']}"
    with_what = "; ".join(f"{name}: {text}" for name, text in versions.items())
    return f"Medians of {rounds} {turns} on {found['date']}, {where}, load {machine['load']} before: {with_what}.\n"


def readme(found: Found, *, portuguese: bool) -> str:
    """Return the table of the README, in one of its languages."""
    titles = TITLES | (PORTUGUESE if portuguese else {})
    rows = [row for row in README if row in found["medians"]]
    players = [name for name in LEAST_PLAYERS if name in players_of(found, rows)]
    body = [
        [ROWS[row].portuguese if portuguese else ROWS[row].english, *cells(found, row, players, ratios=False)]
        for row in rows
    ]
    if portuguese:
        body = [[title, *(commas(each) for each in figures)] for title, *figures in body]
    return table(["", *(titles[name] for name in players)], body)


def commas(figure: str) -> str:
    """Return a figure as Portuguese writes it."""
    return figure.translate(str.maketrans(".,", ",."))


def rounds(found: Found) -> str:
    """Return a table of each row: all who played, with least and most, and three ratios."""
    parts = [conditions(found)]
    for row, of in ROWS.items():
        figures = found["rows"].get(row)
        if not figures:
            continue
        medians, body = found["medians"][row], []
        for name in players_of(found, [row]):
            least, most = (shown(choose(figures[name]), of.unit) for choose in (min, max))
            ratios = [
                f"{medians[name] / medians[base]:.2f}" if base in medians else DASH
                for base in ("robolink", "build", "bare")
            ]
            body.append([TITLES[name], shown(medians[name], of.unit), f"{least} to {most}", *ratios])
        head = ["", "median", "least to most", "over robolink", "over the other build", "over bare Zenoh"]
        parts.append(f"**{of.english[:1].upper()}{of.english[1:]}**\n\n{table(head, body)}")
    parts += [
        f"{game}, {TITLES[name]}: {reason}\n" for game, each in found["failed"].items() for name, reason in each.items()
    ]
    if found["missing"]:
        parts.append(
            "Not there: " + "; ".join(f"{name}, {reason}" for name, reason in found["missing"].items()) + ".\n"
        )
    return "\n".join(parts)


BLOCKS: dict[str, Callable[[Found], str]] = {
    "readme": lambda found: readme(found, portuguese=False),
    "leia-me": lambda found: readme(found, portuguese=True),
    "conditions": conditions,
    "trips": comparison(TRIPS),
    "floods": floods,
    "costs": comparison(COSTS),
    "dds": comparison(("dds",)),
    "alone": alone,
    "rounds": rounds,
}


def page(text: str, found: Found) -> str:
    """Return a page with its blocks as they are made from the file."""
    return _BLOCK.sub(lambda match: f"{match[1]}{BLOCKS[match[2]](found)}{match[3]}", text)


def write(root: Path, found: Found) -> None:
    """Write the blocks of all pages."""
    for name in PAGES:
        file = root / name
        file.write_text(page(file.read_text(encoding="utf-8"), found), encoding="utf-8")


def lines(found: Found, games: Sequence[str]) -> str:
    """Return the printed lines of some rows: medians, least and most."""
    said = []
    for row in [row for row in ROWS if row.split("/")[0] in games]:
        for name in players_of(found, [row]):
            figures, unit = found["rows"][row][name], ROWS[row].unit
            least, most = shown(min(figures), unit), shown(max(figures), unit)
            lost = found["medians"].get(f"{row}/lost", {}).get(name)
            ratio = found["medians"][row][name] / found["medians"][row].get("robolink", found["medians"][row][name])
            text = f"{row:11} {TITLES[name]:15} {shown(found['medians'][row][name], unit):>10} ({least} to {most})"
            said.append(f"{text} {ratio:.2f}" + ("" if lost is None else f", lost {lost:.1%}"))
    return "\n".join(said)
