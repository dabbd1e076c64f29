"""Log what comes on /chatter, best effort or with `--reliable`, a number of times (`-n`, 20)."""

from __future__ import annotations

from robolink.counterparts.demo_nodes_py.listener import Listener
from robolink.counterparts.demo_nodes_py.other_qos import run


def main(args: list[str] | None = None) -> None:
    """Run the listener of the command line."""
    run("listener", Listener, args)


if __name__ == "__main__":
    main()
