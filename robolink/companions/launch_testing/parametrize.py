"""Several launches of one launch test, each with other arguments (`launch_testing.parametrize`)."""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterable
from typing import Any

from robolink.companions.launch.bases import LaunchArgumentError

PARAMETERS = "launch_test_parameters"
"""Attribute of the function with the arguments of each launch."""

Describe = Callable[..., Any]


def parametrize(argnames: str, argvalues: Iterable[Any]) -> Callable[[Describe], Describe]:
    """Return a decorator of generate_test_description: it is called once for each of the values.

    Args:
        argnames: Names of its arguments, parted by commas.
        argvalues: Values, each a tuple if there are several names.

    Raises:
        LaunchArgumentError: for values that do not fit the names.
    """
    names = [each.strip() for each in argnames.split(",") if each.strip()]
    rows = [each if isinstance(each, tuple) else (each,) for each in argvalues]
    for row in rows:
        if len(row) != len(names):
            raise LaunchArgumentError(
                f"parametrize has {len(names)} names, and a row with {len(row)} values: {row!r:.60}"
            )

    def decorate(describe: Describe) -> Describe:
        @functools.wraps(describe)
        def described(**kwargs: Any) -> Any:
            return describe(**kwargs)

        inner = getattr(describe, PARAMETERS, [{}])
        both = [{**of_inner, **dict(zip(names, row, strict=True))} for row in rows for of_inner in inner]
        setattr(described, PARAMETERS, both)
        return described

    return decorate
