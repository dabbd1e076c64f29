"""Publish on /chatter, best effort or with `--reliable`, a number of times (`-n`, 20)."""

from __future__ import annotations

from robolink.counterparts.demo_nodes_py.other_qos import run
from robolink.counterparts.demo_nodes_py.talker import Talker


def main(args: list[str] | None = None) -> None:
    """Run the talker of the command line."""
    run("talker", Talker, args)


if __name__ == "__main__":
    main()
