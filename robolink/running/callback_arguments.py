"""Signature of a callback: with how many arguments it can be called."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from typing import Any


def takes_arguments(function: Callable[..., Any], count: int) -> bool:
    """True if `function` can be called with `count` arguments, or does not tell."""
    try:
        inspect.signature(function).bind(*[None] * count)
    except TypeError:
        return False
    except ValueError:
        return True
    return True
