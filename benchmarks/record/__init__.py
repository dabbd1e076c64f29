"""The benchmark of record: its rows, its peers, and the pages' tables; `benchmarks/peers.py`."""
