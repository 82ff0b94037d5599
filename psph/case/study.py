"""References for errors, and what a study varies: ``[exact]``, ``[experiments]``, ``[study]``."""

from collections.abc import Mapping
from typing import Annotated, Any

from pydantic import Field, Strict, StringConstraints, create_model

from psph.case.keys import Table, Text, key
from psph.case.parameters import NOT_THIS, parameters, summary
from psph.theory.solutions.catalogue import SOLUTIONS

EXACT = "exact"
"""In place of a velocity or a pressure: that of the exact solution at the start."""


def exact_table(solutions: Mapping[str, type] = SOLUTIONS) -> type[Table]:
    """The model of ``[exact]``: one key for each solution."""
    fields: dict[str, Any] = {
        name: (parameters(of) | None, key(summary(of), None, otherwise=NOT_THIS))
        for name, of in solutions.items()
    }
    return create_model(
        "Exact", __base__=Table, __doc__="The exact solution of the case, one at most.", **fields
    )


class Experiment(Table):
    """A measured curve over time, to compare a column of probes.csv or of a gauge with."""

    file: Text = key(
        "CSV file in the case's folder or below; lines that begin with # are comments", min_length=1
    )
    time: Text = key("name of its column of times")
    value: Text = key("name of its column of values")
    probe: Text = key("the column of probes.csv or of a gauge to compare with, such as tip.front")
    time_unit: float = key("seconds per unit of its times", 1.0, unit="s", gt=0)
    value_unit: float = key("the probe's units per unit of its values", 1.0, unit="1")


Choices = Annotated[tuple[float | int | bool | Text, ...], Strict(False), Field(min_length=1)]

Dotted = Annotated[str, StringConstraints(pattern=r"^[A-Za-z0-9_-]+(\.[A-Za-z0-9_-]+|\[[0-9]{1,9}\])*$")]
"""A key as ``--set`` takes it, with places in lists as ``[0]`` or ``.0``."""


class Study(Table):
    """The keys that ``psph study`` varies, and its measure of error."""

    vary: dict[Dotted, Choices] = key(
        'keys and the values that each takes: { "space.spacing" = [0.02, 0.01] }; "off" removes a key',
        {},
    )
    grid: bool = key("all combinations of the values, not one key at a time", False)
    error: Text | None = key(
        "what is compared: velocity, pressure or density of the fluid at the end, a column of probes.csv or "
        "of a gauge over time, or the name of one of the numbers",
        None,
        otherwise="the first that the reference has",
    )
    against: Text | None = key(
        'what it is compared with: "exact", "theory" (of a probe), "finest" (the run with the '
        "smallest spacing) or the name of an experiment",
        None,
        otherwise="the first of these that the case has",
    )
    after: float = key("probes are compared from this time on", 0.0, unit="s", ge=0)
    until: float | None = key(
        "probes are compared up to this time", None, unit="s", otherwise="the end", gt=0
    )
    shift: float | None = key(
        "curves are compared after the best shift in time, of at most so much",
        None,
        unit="s",
        otherwise="as they are",
        gt=0,
    )
    repeats: int = key("number of times that a short run is timed", 3, ge=1)
