"""The map as text: for the terminal, as Markdown, as CSV."""

import csv
import io
from collections.abc import Iterator, Sequence
from pathlib import Path

from psph.lab.maps.survey import SurveyRow, sentences
from psph.output.errors import OutputError, cause
from psph.theory.stability.parts import REMEDIES
from psph.theory.stability.uniform import Settings
from psph.theory.stability.windows import SMOOTHINGS

CSV, PAGE, PICTURE = "map.csv", "map.md", "map.png"
"""Files of a map."""

SHOWN = SMOOTHINGS[::2]
"""h/dx in the tables; the CSV file has them all."""

STABLE = "·"
UNIT = "√(|P|/ρ)/dx"


def subtitle(settings: Settings) -> str:
    """The settings of a map."""
    names = {kind: name.replace("_", " ") for name, kind in REMEDIES.items()}
    return ", ".join(
        [
            f"{settings.lattice} lattice",
            f"{settings.form} pressure gradient",
            f"c = {settings.sound_speed:g} √(|P|/ρ)",
            *(" ".join([names[type(r)], *(f"{v:g}" for v in r)]) for r in settings.remedies),
        ]
    )


def head() -> str:
    """The line above the rows of a terminal."""
    return f"{'h/dx':26}" + "".join(f"{h:>7g}" for h in SHOWN)


def line(row: SurveyRow) -> str:
    """A row for a terminal."""
    return f"{row.kernel:14}{row.state:12}" + "".join(f"{cell:>7}" for cell in _cells(row))


def markdown(settings: Settings, rows: Sequence[SurveyRow]) -> str:
    """Title, table and sentences."""
    lines = [
        f"### {settings.lattice.capitalize()} lattice",
        "",
        f"Fastest growth in {UNIT}; {STABLE} is stable. {_capital(subtitle(settings))}.",
        "",
        f"| kernel | under | {' | '.join(f'{h:g}' for h in SHOWN)} |",
        "|---" * (2 + len(SHOWN)) + "|",
        *(f"| `{row.kernel}` | {row.state} | {' | '.join(_cells(row))} |" for row in rows),
        "",
        *sentences(rows),
    ]
    return "\n".join(lines) + "\n"


def as_csv(settings: Settings, rows: Sequence[SurveyRow]) -> str:
    """Every growth with all its digits and its wave vector."""
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    axes = "xyz"[: len(rows[0].found[0].wave_vector)]
    writer.writerow(
        [
            "lattice",
            "form",
            "state",
            "kernel",
            "smoothing",
            "growth_rate",
            "stable",
            *(f"wave_{axis}" for axis in axes),
        ]
    )
    for row in rows:
        for h, one in zip(SMOOTHINGS, row.found):
            writer.writerow(
                [
                    settings.lattice,
                    settings.form,
                    row.state,
                    row.kernel,
                    h,
                    one.rate,
                    one.stable,
                    *one.wave_vector.tolist(),
                ]
            )
    return out.getvalue()


def write(path: Path, text: str) -> None:
    """Write a text to a file.  Raises OutputError."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
    except OSError as error:
        raise OutputError(f"{path}: {cause(error)}; choose another folder with --out") from None


def _cells(row: SurveyRow) -> Iterator[str]:
    for h, one in zip(SMOOTHINGS, row.found):
        if h in SHOWN:
            yield STABLE if one.stable else f"{one.rate:.2g}"


def _capital(text: str) -> str:
    return text[0].upper() + text[1:]
