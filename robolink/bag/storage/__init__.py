"""Storages of bags: the files that messages are in, MCAP or sqlite3, each behind the same few methods."""
