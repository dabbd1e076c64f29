"""Monitor of transforms for `robolink tf monitor`: their publishers, rates and delays."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from robolink.cli.shared.layout import Figures, figures_of
from robolink.cli.shared.output import say, say_json, tell
from robolink.cli.shared.session import node_of, opened
from robolink.cli.tf.echo import ASKER, why_not
from robolink.cli.tf.watch import Seen, Watch
from robolink.system import clocks
from robolink.tf2.cache import LATEST
from robolink.tf2.exceptions import TransformException


def run(source: str, target: str, period: float, *, json: bool) -> None:
    """Report every `period` seconds, on all frames or on the chain between two, until Ctrl-C."""
    with opened() as context:
        watch = Watch(node_of(context))
        if not json:
            what = f"{source} -> {target}" if target else "all frames"
            say(f"Gathering data on {what} for {period:g} seconds...")
        explained = False
        while True:
            watch.listen(period)
            chain = _chain(watch, source, target) if target else None
            if not watch.links or (chain is None and target):
                if not explained:
                    why = why_not(watch, source, target)
                    tell(why if why.startswith("waiting") else f"waiting: {why}")
                explained = True
            elif json:
                say_json(_data(watch, chain))
            else:
                say(_text(watch, chain))


def _chain(watch: Watch, source: str, target: str) -> list[str] | None:
    """Return the frames from one to the other; None while nothing connects them."""
    try:
        return watch.tree.chain(target, source, LATEST, ASKER)
    except TransformException:
        return None


def _shown(watch: Watch, chain: list[str] | None) -> list[Seen]:
    return [each for each in watch.links.values() if chain is None or each.child in chain]


def _text(watch: Watch, chain: list[str] | None) -> str:
    lines = ["", "", "", f"RESULTS: for {f'{chain[0]} to {chain[-1]}' if chain else 'all Frames'}"]
    if chain is not None:
        lines += [f"Chain is: {' -> '.join(chain)}", _net_delay(watch, chain)]
    lines += ["", "Frames:"]
    lines += [_frame(each) for each in sorted(_shown(watch, chain), key=lambda each: each.child)]
    lines += ["", "All Broadcasters:"]
    for sender in sorted({each.sender for each in watch.links.values()}):
        lines.append(_broadcaster(sender, [each for each in watch.links.values() if each.sender == sender]))
    return "\n".join(lines)


def _net_delay(watch: Watch, chain: list[str]) -> str:
    stamp = watch.tree.path(chain[-1], chain[0], LATEST, ASKER)[1]
    delay = f"{(clocks.now() - stamp) / 1e9:.6g}" if stamp else "0 (all of it is static)"
    return f"Net delay     now = {delay}"


def _frame(seen: Seen) -> str:
    begin = f"Frame: {seen.child}, published by {seen.sender}"
    found = figures_of(seen.delays)
    if seen.static or found is None:
        return f"{begin}, static"
    return f"{begin}, Average Delay: {found.mean:.6g}, Max Delay: {found.high:.6g}"


def _broadcaster(sender: str, links: list[Seen]) -> str:
    found = _moving(links)
    if found is None:
        return f"Node: {sender} static"
    rate = max((each.rate or 0.0 for each in links if not each.static), default=0.0)
    return f"Node: {sender} {rate:.6g} Hz, Average Delay: {found.mean:.6g} Max Delay: {found.high:.6g}"


def _moving(links: Iterable[Seen]) -> Figures | None:
    return figures_of([delay for each in links if not each.static for delay in each.delays])


def _data(watch: Watch, chain: list[str] | None) -> dict[str, Any]:
    frames = []
    for each in _shown(watch, chain):
        found = None if each.static else figures_of(each.delays)
        frames.append(
            {
                "frame": each.child,
                "parent": each.parent,
                "publisher": each.sender,
                "static": each.static,
                "rate": None if each.static else each.rate,
                "average_delay": found.mean if found else None,
                "max_delay": found.high if found else None,
            }
        )
    return {"chain": chain, "frames": frames}
