"""The order of the pages: the lists of links of each index.md, which a forge shows as they are.

A heading of docs/index.md with its list becomes a part of the navigation.  Pages that nothing lists come
at its end, so that a new page needs no line anywhere.
"""

import re
from pathlib import Path, PurePosixPath

TOP = "docs/index"
REST = "More"
LINK = re.compile(r"\]\(([\w./-]+)\.md\)")
TOCTREE = "```{{toctree}}\n:hidden:\n{options}\n\n{pages}\n```\n"


def pages_of(root: Path) -> list[str]:
    """Every page of the site, by its path without the ending."""
    found = [root / "README.md", root / "CHANGELOG.md", *(root / "docs").rglob("*.md")]
    return sorted(path.relative_to(root).with_suffix("").as_posix() for path in found if path.exists())


def linked(text: str, page: str) -> list[str]:
    """The pages that a text links to, in their order, each once."""
    folder = PurePosixPath(page).parent
    return list(dict.fromkeys(_normal(folder / target) for target in LINK.findall(text)))


def parts(text: str, pages: list[str]) -> dict[str, list[str]]:
    """The pages below each heading of docs/index.md, those of no list under ``REST``.

    A folder with an index of its own lists its pages itself.
    """
    found: dict[str, list[str]] = {}
    for section in text.split("\n## ")[1:]:
        heading, _, body = section.partition("\n")
        found[heading] = linked(body, TOP)
    listed = {page for group in found.values() for page in group} | {TOP}
    folders = {page.removesuffix("index") for page in pages if page.endswith("/index") and page != TOP}
    rest = [page for page in pages if page not in listed and not any(page.startswith(f) for f in folders)]
    if rest:
        found[REST] = [*found.get(REST, []), *rest]
    return found


def below(page: str, text: str, pages: list[str]) -> list[str]:
    """The pages of an index below the top: those that it links to first, then the others of its folder."""
    folder = page.removesuffix("index")
    own = [other for other in pages if other.startswith(folder) and other != page]
    return [other for other in linked(text, page) if other in own] + [
        other for other in own if other not in linked(text, page)
    ]


def _normal(path: PurePosixPath) -> str:
    steps: list[str] = []
    for step in path.parts:
        if step == "..":
            steps.pop()
        else:
            steps.append(step)
    return "/".join(steps)


def _toctree(pages: list[str], *options: str) -> str:
    return TOCTREE.format(options="\n".join(options), pages="\n".join(f"/{page}" for page in pages))


def add(app, page: str, source: list[str]) -> None:
    """Let an index end with the hidden list of its pages."""
    pages = pages_of(Path(app.srcdir))
    if page == TOP:
        trees = [_toctree(group, f":caption: {name}") for name, group in parts(source[0], pages).items()]
    elif page.endswith("/index"):
        trees = [_toctree(below(page, source[0], pages))]
    else:
        return
    source[0] = "\n\n".join([source[0], *trees])


def front(app, failure) -> None:
    """A first page at the root of the site, which leads to that of the documentation."""
    if failure is None and app.builder.format == "html":
        to = f"{TOP}.html"
        text = f'<!doctype html><meta http-equiv="refresh" content="0; url={to}"><a href="{to}">psph</a>\n'
        (Path(app.outdir) / "index.html").write_text(text, encoding="utf-8")


def setup(app) -> dict:
    """For Sphinx."""
    app.connect("source-read", add)
    app.connect("build-finished", front)
    return {"parallel_read_safe": True}
