"""The door of a running launcher, and how commands in other shells find it and speak with it.

`control` answers at it and `asking` asks; `talk` is what both speak, `runtime` where launchers leave word.
"""
