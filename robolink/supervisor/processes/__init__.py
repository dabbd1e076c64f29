"""Programs as processes: started in a group of their own, kept on cores, stopped, and never left behind.

`process` is one; it leaves the `terminal` as it was and may be kept on some cores (`affinity`). Should the supervisor
be killed, a program that watches its `lifeline` ends by itself, and the `guardian` ends the others.
"""
