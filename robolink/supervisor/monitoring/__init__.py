"""Monitoring of a running system: file watching for restarts, and CPU and memory use.

`file_watch` restarts a process when one of its files is saved; `resources` measures. Both work on a `periodic` thread.
"""
