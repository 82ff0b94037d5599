"""The report of a study, a battery, a map or a bench: its page, a diagram for the mouse, its pictures."""

from pathlib import Path

from psph.lab.report import battery, bench, elastic, maps, study
from psph.lab.report.sheet import Told, embedded, interactive, written
from psph.output.checkpoint import COPY
from psph.runs.summary import UNTOLD, read_summary

TEMPLATE = "results.html"


def report_of_results(path: Path) -> Path | None:
    """Write the report of what was measured in ``path``; its path, None where nothing of that kind is there.

    ``path`` is the folder of a study, of a battery, of remedies or walls compared, of a map or a table of
    ``stability``, or a file of ``bench --json``.
    """
    for told in (study.told, battery.told, maps.told, elastic.told, bench.told):
        if found := told(path):
            return _write(found)
    return None


def _write(told: Told) -> Path:
    from markdown_it import MarkdownIt

    summary = UNTOLD | (read_summary(told.run) if told.run else {})
    markdown = MarkdownIt("commonmark", {"html": False}).enable("table")
    return written(
        TEMPLATE,
        told.out,
        title=told.title,
        kind=told.kind,
        text=markdown.render(told.text),
        diagram=interactive(told.figure, "diagram"),
        caption=told.caption,
        pictures=[(path.stem, embedded(path, "image/png")) for path in told.pictures if path.is_file()],
        summary=summary,
        case=(told.run / COPY).read_text(encoding="utf-8") if told.run else "",
    )
