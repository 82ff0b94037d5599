"""What a run leaves, as arrays: frames, log, probes; a picture of it without psph's help."""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import psph

CASES = Path(__file__).parents[1] / "cases"
coarse = {"space.spacing": 0.1, "time.end": 0.6}
case = psph.load(CASES / "dam_break.toml", coarse)
psph.run(case, "results/python/dam", overwrite=True, quiet=True)

results = psph.results("results/python/dam")
print(results)
frame = results.frames.at(0.5)
water = frame.fluid
speed = np.linalg.norm(frame.velocity[water], axis=1)
print(f"at {frame.time:.3f} s: {water.sum()} particles of water, up to {speed.max():.2f} m/s")
print(f"pressure up to {frame['pressure'][water].max():.0f} {frame.unit('pressure')}")

tip = results.probes["tip.front"]
print(f"the front moved from {tip[0]:.2f} to {tip[-1]:.2f} {results.probes.units['tip.front']}")
level = results.measure(["mid.level={foot=[0.5, 0.0], top=[0.5, 2.0]}"])["mid"]
least = level.number("mid.level", "minimum")
print(f"at x = 0.5 m the water falls to {least.value:.2f} m, at {least.time:.2f} s")
[grid] = results.grid([0.5], step=0.1, fields=["pressure"])
print(f"up to {np.nanmax(grid.fields['pressure']):.0f} Pa at {grid.fields['pressure'].size} points of a grid")
log = results.log.to_structured()
print(log[["time", "kinetic_energy"]][-1])

plt.scatter(*frame.position[water].T, c=speed, s=8)
plt.gca().set_aspect("equal")
plt.savefig(results.folder / "mine.png")
