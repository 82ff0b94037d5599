"""A script that opens a run in ParaView with its colours.

A script, not a state file (.pvsm): that lists every property of every view of one version of ParaView, and
absolute paths.  A script can be read, changed and moved with the folder.
"""

import os
import tomllib
from pathlib import Path

import numpy as np

from psph.fields import FLUID as FLUID_KIND
from psph.output.export.parts import Exported
from psph.output.pictures import style
from psph.output.pictures.names import PARAVIEW
from psph.output.pictures.quantities import SPEED, quantity
from psph.output.pictures.scale import scale_of
from psph.output.sizes import LENGTH
from psph.output.xdmf import ENDING, index_of

_SCRIPT = '''"""Shows {name} in ParaView 5.10 or newer: paraview --script={script}

pvpython or pvbatch {script} picture.png draws the last frame without a window.
"""

import os
import sys

from paraview.simple import *

FRAMES = {frames!r}
SPACING = {spacing!r}  # m
SIZE, SMOOTHING = {size!r}, {smoothing!r}  # the field of sizes where they differ, and η
SPEED = {speed!r}  # m/s, from no colour to full
PARTS = {parts!r}  # (name, first group, last group, colour or None for the speed, opacity)

frames = os.path.join(os.path.dirname(os.path.abspath(__file__)), FRAMES)
particles = XDMFReader(registrationName="particles", FileNames=[frames])
particles.UpdatePipeline()
view = GetActiveViewOrCreate("RenderView")
view.UseColorPaletteForBackground = 0
view.Background = [1.0, 1.0, 1.0]
view.OrientationAxesLabelColor = [0.13, 0.15, 0.17]
for name, first, last, colour, opacity in PARTS:
    part = Threshold(registrationName=name, Input=particles)
    part.Scalars = ["POINTS", "group"]
    part.ThresholdMethod = "Between"
    part.LowerThreshold = first
    part.UpperThreshold = last
    shown = Show(part, view)
    shown.SetRepresentationType("Point Gaussian")
    shown.ShaderPreset = "Sphere"
    shown.GaussianRadius = 0.5 * SPACING
    if SIZE:  # half a smoothing length over η
        shown.ScaleByArray, shown.UseScaleFunction = 1, 0
        shown.SetScaleArray = ["POINTS", SIZE]
        shown.GaussianRadius = 0.5 / SMOOTHING
    shown.Opacity = opacity
    if colour is None:
        ColorBy(shown, ("POINTS", "velocity", "Magnitude"))
        shown.RescaleTransferFunctionToDataRange(False, True)
        shown.SetScalarBarVisibility(view, True)
    else:
        ColorBy(shown, None)
        shown.AmbientColor = shown.DiffuseColor = colour
speed = GetColorTransferFunction("velocity")
speed.ApplyPreset("Viridis (matplotlib)", True)
speed.RescaleTransferFunction(*SPEED)
bar = GetScalarBar(speed, view)
bar.Title, bar.ComponentTitle = "speed (m/s)", ""
bar.TitleColor = bar.LabelColor = [0.13, 0.15, 0.17]
scene = GetAnimationScene()
scene.UpdateAnimationUsingDataTimeSteps()
scene.GoToLast()
{camera}
ResetCamera(view)
Render(view)
if len(sys.argv) > 1:
    SaveScreenshot(sys.argv[1], view, ImageResolution=[1600, 900])
'''

_CAMERA = """view.CameraPosition = [-1.0, -2.0, 1.0]
view.CameraFocalPoint = [0.0, 0.0, 0.0]
view.CameraViewUp = [0.0, 0.0, 1.0]"""
_PLANE = 'view.InteractionMode = "2D"'

_OPACITY = {"wall": 0.3}
"""Of what is not opaque, by how it looks (psph.scene.parts.part)."""

_PLAIN = {"wall": style.WALLS, "rigid body": style.WHOLE}
"""Colours of what is not shown by its speed."""


def write_paraview(exported: Exported, folder: Path) -> Path:
    """Write ``paraview.py`` for the run's XDMF file into ``folder``; its path.

    Fluids and elastic solids by speed, with the colours of the pictures of ``plot``, walls half
    transparent, bodies in one colour.
    """
    index = index_of(exported.run.path) or exported.run.path.with_suffix(ENDING)
    frames = Path(os.path.relpath(index, folder)).as_posix()
    looks = (part.looks for part in exported.scene.layout.parts)
    shown = [
        (name, k, k, _rgb(_PLAIN[one]) if one in _PLAIN else None, _OPACITY.get(one, 1.0))
        for k, (name, one) in enumerate(zip(exported.names, looks))
    ]
    text = _SCRIPT.format(
        name=exported.stem,
        script=PARAVIEW,
        frames=frames,
        spacing=exported.scene.spacing,
        size=LENGTH if LENGTH in exported.run.fields else None,
        smoothing=exported.scene.case.space.smoothing,
        speed=_speeds(exported),
        parts=shown,
        camera=_CAMERA if exported.scene.dimensions == 3 else _PLANE,
    )
    path = folder / PARAVIEW
    path.write_text(text, encoding="utf-8")
    return path


def _speeds(exported: Exported) -> tuple[float, float]:
    """The speeds between which the colours run, m/s, over the run."""
    run = exported.run
    shown = quantity(run, tomllib.loads(run.case_text), SPEED)
    last = len(exported.times) - 1
    sampled = {round(k) for k in np.linspace(0, last, shown.samples)}
    frames = [run.frame(k, "kind", *shown.reads) for k in sorted(sampled)]
    fluid = any((frame["kind"] == FLUID_KIND).any() for frame in frames)
    values = [shown.values(frame)[(frame["kind"] == FLUID_KIND) | (not fluid)] for frame in frames]
    scale = scale_of(shown, values)
    return float(scale.norm.vmin / scale.factor), float(scale.norm.vmax / scale.factor)


def _rgb(colour: str) -> list[float]:
    """#rrggbb as three numbers from 0 to 1."""
    return [round(int(colour[k : k + 2], 16) / 255, 3) for k in (1, 3, 5)]
