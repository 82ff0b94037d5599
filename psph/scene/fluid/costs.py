"""What each of several fluids costs in time: its part of the particles, and the steps its sound allows."""

from collections.abc import Iterator

from psph.scene.scene import Scene


def cost_lines(scene: Scene, cfl: float) -> Iterator[str]:
    """A line for each fluid of a scene with several: a step costs as its particles, and there are as many of
    them as the fluid with the fastest sound asks for, Δt ≤ ``cfl`` h/(c + U) (Monaghan 1992)."""
    parts = [part for part in scene.layout.parts if part.flows and part.source == part.number]
    if len(parts) < 2:
        return
    sizes = [int(scene.census.sizes[part.number]) for part in parts]
    speeds = [scene.species[part.number].sound_speed for part in parts]
    fastest, width = max(speeds), max(len(part.name) for part in parts)
    for part, size, speed in zip(parts, sizes, speeds):
        allowed = cfl * scene.smoothing_length / (speed + scene.expected_speed)
        fewer = (fastest + scene.expected_speed) / (speed + scene.expected_speed)
        share = f"{size:,} of {sum(sizes):,} particles"
        steps = f"by itself {fewer:.2g} times as long" if fewer > 1.0 else "none asks for shorter ones"
        yield f"{part.name:<{width}}  {share}; sound allows steps of {allowed:.3g} s, {steps}"
