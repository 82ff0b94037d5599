"""Load a case, look at what it will simulate, run it, and say where the water is at the end."""

from pathlib import Path

import psph

CASES = Path(__file__).parents[1] / "cases"

case = psph.load(CASES / "minimal.toml").with_({"time.end": 0.3})
for finding in case.check():
    print(finding.kind, finding.key, finding.says)
plan = case.explain()
print(f"{plan.particles:,} particles, about {plan.steps:,} steps")
print("acting:", ", ".join(effect.name for effect in plan.effects))

results = psph.run(case, "results/python/first", overwrite=True)
last = results.frames[-1]
print(f"at {last.time:g} s the water has come to x = {last.position[last.fluid, 0].max():.2f} m")
