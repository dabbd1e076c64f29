"""MuJoCo's camera beside robolink's, for `benchmarks/camera.py`: the same faces as thin boxes, without shadows.

MuJoCo renders by OpenGL; without a graphics card that is OSMesa or EGL (the variable MUJOCO_GL).
"""

from __future__ import annotations

import importlib
import math
import statistics
import time
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from robolink.sim.rendering.renderer import Setting

Place = tuple[float, float, float, float, float]


def mujoco_camera(
    scene: tuple[Setting, Any], views: Sequence[Place], runs: int = 20
) -> Callable[[tuple[int, int]], str] | None:
    """Return a function that tells how long MuJoCo takes for an image of a size; None if it cannot render here."""
    try:
        mujoco = importlib.import_module("mujoco")
        model = mujoco.MjModel.from_xml_string(_scene(*scene))
        mujoco.Renderer(model, 8, 8).close()
    except Exception:  # noqa: BLE001 - it has many ways to say that there is no OpenGL
        return None
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)

    def reported(size: tuple[int, int]) -> str:
        renderer, least = mujoco.Renderer(model, size[1], size[0]), []
        renderer.scene.flags[mujoco.mjtRndFlag.mjRND_SHADOW] = 0
        for x, y, z, yaw, pitch in views:
            camera, times = mujoco.MjvCamera(), []
            camera.lookat = (x + math.cos(yaw), y + math.sin(yaw), z - math.tan(pitch))
            camera.distance, camera.azimuth, camera.elevation = 1.0, math.degrees(yaw), -math.degrees(pitch)
            for _ in range(runs):
                begin = time.perf_counter()
                renderer.update_scene(data, camera)
                renderer.render()
                times.append(1000 * (time.perf_counter() - begin))
            least.append(min(times))
        renderer.close()
        return f"MuJoCo {statistics.mean(least):.2f} ms"

    return reported


def _scene(setting: Setting, places: Any) -> str:
    """Return a model of the scene: each upright or level face is a box a millimetre thick, each cylinder a cylinder."""
    patches, cylinders = setting.at(places)
    parts = []
    for corner, a, b in zip(patches.corner.T, patches.a.T, patches.b.T, strict=True):
        middle, along, across = corner + a / 2 + b / 2, np.linalg.norm(a) / 2, np.linalg.norm(b) / 2
        axes = " ".join(f"{each:.6f}" for each in (*a / (2 * along), *b / (2 * across)))
        place = " ".join(f"{each:.6f}" for each in middle)
        parts.append(f'<geom type="box" size="{along:.4f} {across:.4f} 0.0005" pos="{place}" xyaxes="{axes}"/>')
    for x, y, radius, low, high in zip(*cylinders[:5], strict=True):
        size, middle = f"{radius:.4f} {(high - low) / 2:.4f}", f"{x:.4f} {y:.4f} {(low + high) / 2:.4f}"
        parts.append(f'<geom type="cylinder" size="{size}" pos="{middle}"/>')
    body = "".join(parts)
    floor = (
        '<texture name="grid" type="2d" builtin="checker" width="512" height="512" rgb1=".6 .6 .6" rgb2=".5 .5 .5"/>'
    )
    paint = '<material name="floor" texture="grid" texrepeat="5 5"/>'
    return (
        f'<mujoco><asset>{floor}{paint}</asset><visual><global offwidth="2000" offheight="2000"/></visual><worldbody>'
        f'<light pos="5 4 6"/><geom type="plane" size="20 20 1" material="floor"/>{body}</worldbody></mujoco>'
    )
