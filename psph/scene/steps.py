"""What is said of the time steps of a scene."""

from collections.abc import Iterator


def shorter_step(scene) -> Iterator[str]:
    """The cure of what goes too far in a step."""
    step, cfl = scene.case.time.step, scene.case.time.cfl
    if step is None:
        yield f"try a smaller time.cfl, {cfl / 2:g} instead of {cfl:g}"
    else:
        yield f"try a smaller time.step than {step:g} s"
