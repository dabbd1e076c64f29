"""Command whose options take several values in a row, as argparse's do in ros2: `--topics /scan /odom`."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import Any

import typer.core


class ListedOptions(typer.core.TyperCommand):
    """Command in which each option that may be repeated takes all the words up to the next option."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Parse the arguments."""
        flags = {flag for each in self.params if getattr(each, "multiple", False) for flag in each.opts}
        left: list[str] = super().parse_args(ctx, repeated(args, flags))
        return left


def repeated(args: Sequence[str], flags: Collection[str]) -> list[str]:
    """Return the arguments with one of these flags before each of its values: click's take one value each.

    >>> repeated(["--topics", "/a", "/b", "-o", "bag"], ["--topics"])
    ['--topics', '/a', '--topics', '/b', '-o', 'bag']
    """
    result: list[str] = []
    flag, has_value = "", False
    for index, each in enumerate(args):
        if flag and not each.startswith("-"):
            result += [flag, each]
            has_value = True
            continue
        if flag and not has_value:
            result.append(flag)  # click says that its value is missing
        if each == "--":
            return [*result, *args[index:]]
        flag, has_value = (each, False) if each in flags else ("", False)
        if not flag:
            result.append(each)
    return [*result, flag] if flag and not has_value else result
