"""List of the tests that failed last, from pytest's cache; exit code 1 if there are none, or too many to run again.

Usage: python tools/failed_tests.py CACHE/v/cache/lastfailed MOST
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

if __name__ == "__main__":
    failed, most = sorted(json.loads(Path(sys.argv[1]).read_text(encoding="utf-8"))), int(sys.argv[2])
    sys.stdout.write("\n    ".join([f"--- {len(failed)} failed:", *failed[: most + 1]]) + "\n")
    sys.exit(not 0 < len(failed) <= most)
