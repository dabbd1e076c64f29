"""Reporting of a running system: to the terminal, to log files, and as events to programs.

The `dispatcher` passes everything to the `printer` and to programs, each behind a `background_queue` for slow readers,
and to the `logs`. It finds why a program ended, for the lines about it and for the summary at the end.
"""
