"""The same collapse under three schemes: how far the front comes, and how far the density strays."""

from pathlib import Path

import psph

CASES = Path(__file__).parents[1] / "cases"

case = psph.load(CASES / "minimal.toml").with_({"space.spacing": 0.04, "time.end": 0.2})
for scheme in ("stable", "sph"):
    changed = case.with_(scheme=scheme, physics__sound_speed=40.0)
    results = psph.run(changed, f"results/python/{scheme}", overwrite=True, quiet=True)
    last = results.frames[-1]
    front = last.position[last.fluid, 0].max()
    astray = 100 * results.log["density_error"].max()
    print(f"{scheme}: front at {front:.3f} m, density within {astray:.2g} %")
