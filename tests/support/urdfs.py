"""Robot models in URDF for tests: a small arm, and texts around joints."""

from __future__ import annotations

ARM = """<?xml version="1.0"?>
<robot name="arm">
  <link name="base_link"/>
  <link name="camera"/>
  <link name="upper"/>
  <link name="slide"/>
  <link name="left_finger"/>
  <link name="right_finger"/>
  <joint name="mount" type="fixed">
    <parent link="base_link"/> <child link="camera"/>
    <origin xyz="0.1 0 0.5" rpy="0 0 1.5707963267948966"/>
  </joint>
  <joint name="shoulder" type="revolute">
    <parent link="base_link"/> <child link="upper"/>
    <origin xyz="0 0 1"/> <axis xyz="0 0 2"/>
    <limit lower="-1.5" upper="1.5" effort="1" velocity="1"/>
  </joint>
  <joint name="extend" type="prismatic">
    <parent link="upper"/> <child link="slide"/>
    <axis xyz="0 1 0"/> <limit lower="0.2" upper="0.6" effort="1" velocity="1"/>
    <safety_controller soft_upper_limit="0.4" k_velocity="1"/>
  </joint>
  <joint name="left" type="continuous">
    <parent link="slide"/> <child link="left_finger"/>
  </joint>
  <joint name="right" type="continuous">
    <parent link="slide"/> <child link="right_finger"/>
    <mimic joint="left" multiplier="-2" offset="0.5"/>
  </joint>
</robot>
"""


def robot(*joints: str, links: str = "a b c") -> str:
    """A model with these links, and joints as `joint` writes them; the links are in line 2, each joint in a line."""
    written = "".join(f'<link name="{each}"/>' for each in links.split())
    return "\n".join(['<robot name="r">', written, *joints, "</robot>"])


def joint(name: str, parent: str, child: str, inner: str = "", kind: str = "fixed") -> str:
    return f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>{inner}</joint>'
