"""Control socket of a running launcher, with shared-secret authentication, for commands in other shells.

`server` answers and `client` asks; `protocol` is what both speak, `registry` is where clients find launchers.
"""
