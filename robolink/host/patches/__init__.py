"""Monkey patches by which programs of a host live in virtual time; docs/development/host.md lists every name.

`install` puts them in place while there is a host. `environment` and `snapshot` keep what programs see and change of
the process apart.
"""
