"""Ask the service /add_two_ints for 2 + 3 without waiting, and log the sum when it comes."""

from __future__ import annotations

from robolink.counterparts.demo_nodes_cpp.add_two_ints_client import ask


def main(args: list[str] | None = None) -> None:
    """Ask for a sum."""
    ask("add_two_ints_client_async", args)


if __name__ == "__main__":
    main()
