"""The report of a study, a battery, a map or a bench: its page, a diagram for the mouse, its pictures."""

from pathlib import Path

from psph.lab.report import battery, bench, elastic, maps, study
from psph.lab.report.sheet import Result, embedded, interactive, written
from psph.output.checkpoint import COPY
from psph.runs.summary import NO_SUMMARY, read_summary

TEMPLATE = "results.html"


def report_of_results(path: Path) -> Path | None:
    """Write the report of what was measured in ``path``; its path, None where nothing of that kind is there.

    ``path`` is the folder of a study, of a battery, of remedies or walls compared, of a map or a table of
    ``stability``, or a file of ``bench --json``.
    """
    for result_of in (study.result_of, battery.result_of, maps.result_of, elastic.result_of, bench.result_of):
        if found := result_of(path):
            return _write(found)
    return None


def _write(result: Result) -> Path:
    from markdown_it import MarkdownIt

    summary = NO_SUMMARY | (read_summary(result.run) if result.run else {})
    markdown = MarkdownIt("commonmark", {"html": False}).enable("table")
    return written(
        TEMPLATE,
        result.out,
        title=result.title,
        kind=result.kind,
        text=markdown.render(result.text),
        diagram=interactive(result.figure, "diagram"),
        caption=result.caption,
        pictures=[(path.stem, embedded(path, "image/png")) for path in result.pictures if path.is_file()],
        summary=summary,
        case=(result.run / COPY).read_text(encoding="utf-8") if result.run else "",
    )
