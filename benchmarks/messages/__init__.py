"""Two ends of a benchmark of messages, as robolink's nodes and as programs of its peers; `benchmarks/messaging.py`."""
