"""The parameter file that  writes of the node /lab/driver."""

from __future__ import annotations

DUMPED = """\
/lab/driver:
  ros__parameters:
    arm:
      ids:
      - 1
      - 2
      length: 3
    free: 1
    gains:
    - 1.0
    - 2.5
    name: '1e3'
    odd..: true
    speed: 1.0
    start_type_description_service: true
    use_sim_time: false
"""
