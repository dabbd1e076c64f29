"""Options of content filters, which other networks apply to what a subscription receives."""

from __future__ import annotations

from typing import NamedTuple


class ContentFilterOptions(NamedTuple):
    """A filter: an SQL-like expression, and the values of its `%0`, `%1` ...

    Args:
        filter_expression: Expression over the message's fields; '' stands for none.
        expression_parameters: Texts that replace the parameters of the expression.
    """

    filter_expression: str
    expression_parameters: list[str]
