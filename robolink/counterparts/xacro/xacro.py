"""Expand the macros of a xacro file, and print the XML.

robolink run xacro xacro robot.urdf.xacro use_sim:=true
"""

from __future__ import annotations

import sys

from robolink.counterparts.program import own_words
from robolink.counterparts.xacro.expansion import expanded


def main(args: list[str] | None = None) -> None:
    """Print the expanded file of the command line; `args` begin with the program's name."""
    sys.stdout.write(expanded(own_words(args)))


if __name__ == "__main__":
    main()
