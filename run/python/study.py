"""How the error falls with the spacing, as a table."""

from pathlib import Path

import psph

CASES = Path(__file__).parents[1] / "cases"

case = psph.load(CASES / "taylor_green.toml").with_({"time.end": 0.05, "study.repeats": 1})
found = psph.study(case, {"space.spacing": [0.05, 0.025]}, out="results/python/taylor-green", quiet=True)
print(f"error: {found.error}")
for spacing, error, seconds in zip(*(found.table[name] for name in ("space.spacing", "error_l2", "seconds"))):
    print(f"spacing {spacing:g} m: {100 * error:.2g} % in {seconds:.1f} s")
