"""Reporting of a running system: to the terminal, to log files, and as events to programs.

The `dispatcher` passes everything to the `printer` and the `notifier`, each behind a `background_queue` for slow
readers, and to the `logs`. `writer` writes whole lines; `causes` finds why a program ended, `summary` is for the end.
"""
