"""Child processes: each in a process group of its own, with CPU affinity, and never left behind.

`process` starts and stops one, puts the terminal back, and may set the `affinity`. If the supervisor is killed,
a program that watches its `lifeline` ends by itself, and the `guardian`, a watchdog process, kills the others.
"""
