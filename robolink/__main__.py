"""`python -m robolink` is the command line too."""

import sys


def main() -> int:
    """Run the command; 130 for a Ctrl-C that comes before there is anything to interrupt."""
    try:
        from robolink.cli.main import main as command

        return command()
    except KeyboardInterrupt:
        return 130


if __name__ == "__main__":
    sys.exit(main())
