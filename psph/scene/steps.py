"""What is said of the time steps of a scene."""

from collections.abc import Iterator


def finest_of(scene):
    """A ``scene`` as its finest level of sizes sees it: that has the shortest steps."""
    return (scene, *scene.finer)[-1]


def shorter_step(scene) -> Iterator[str]:
    """The cure of what goes too far in a step."""
    step, cfl = scene.case.time.step, scene.case.time.cfl
    if step is None:
        yield f"try a smaller time.cfl, {cfl / 2:g} instead of {cfl:g}"
    else:
        yield f"try a smaller time.step than {step:g} s"
