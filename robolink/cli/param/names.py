"""Shell completion of the names of a node's parameters, from the node itself."""

from __future__ import annotations

import contextlib
import queue
import threading
from typing import Any

from robolink.cli.shared.complete import WITHIN, offered


def of_node(ctx: Any, incomplete: str) -> list[str]:
    """Return the parameters of the node on the command line; nothing if it does not answer in time."""
    names: queue.SimpleQueue[list[str]] = queue.SimpleQueue()
    node = str(ctx.params.get("node") or "")
    # In the background, since neither the network nor the node need answer.
    threading.Thread(target=_ask, args=(node, names), name="robolink completion", daemon=True).start()
    with contextlib.suppress(queue.Empty):
        return offered(names.get(timeout=2 * WITHIN), incomplete)
    return []


def _ask(node: str, names: queue.SimpleQueue[list[str]]) -> None:
    from robolink.cli.param.ask import ParameterClient, serves
    from robolink.cli.shared.graph import absolute
    from robolink.cli.shared.session import node_of
    from robolink.context import Context

    context = Context()
    try:
        context.init(args=[])
        name = absolute(node)
        if serves(context, name):
            names.put(ParameterClient(node_of(context), name).names())
    except Exception:  # noqa: BLE001, S110 - there is nothing to offer, and nobody to tell
        pass
    finally:
        names.put([])
        context.try_shutdown()
