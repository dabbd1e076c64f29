"""`python -m robolink` is the command line too."""

import sys

from robolink.cli import main

if __name__ == "__main__":
    sys.exit(main())
