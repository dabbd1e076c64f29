"""What is told of a system: to the terminal, to log files, and as events to programs.

All passes through the `teller`: to the `printer` and the `notifier`, each by a `courier` for those who read slowly, and
to the `logs`. `writer` writes lines whole; `causes` finds why a program ended, `summary` says it at the end.
"""
