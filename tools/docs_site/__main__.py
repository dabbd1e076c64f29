"""Command line of the site's tools: it builds the site; `same-code` and `pictures` renew files."""

from __future__ import annotations

import sys
import time

from tools.docs_site.build import SERVE, SITE, build
from tools.docs_site.same_code import copy_code

USAGE = "usage: python -m tools.docs_site [build | same-code | pictures [NAME]...]"


def main(words: list[str]) -> int:
    """Do what is asked; return the exit code."""
    if words in ([], ["build"]):
        started = time.monotonic()
        code = build()
        if not code:
            print(f"the site is in {SITE} ({time.monotonic() - started:.1f} s): open index.html, or with a search:")  # noqa: T201
            print(f"  {SERVE} {SITE}    # then http://localhost:8000")  # noqa: T201
        return code
    if words[0] == "pictures":
        from tools.docs_site.pictures import write  # its simulator is not needed by the rest

        write(words[1:])
        return 0
    if words == ["same-code"]:
        copy_code()
        return 0
    print(USAGE, file=sys.stderr)  # noqa: T201
    return 2


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
