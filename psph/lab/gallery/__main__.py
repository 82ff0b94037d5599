"""``python -m psph.lab.gallery [CASE ...]``: run, draw and list shipped cases, from the root of psph.

CASE is a name such as ``mud/bingham_slump``; without one all are drawn.  ``--missing``: those without a
picture.  ``--pages``: only the page docs/gallery/index.md is written.
"""

import sys
from collections.abc import Sequence

from psph.errors import Refused
from psph.lab.gallery import pages
from psph.lab.gallery.drawing import draw
from psph.lab.gallery.shown import Shown, every

MISSING, PAGES = "--missing", "--pages"


def chosen(shown: list[Shown], words: Sequence[str]) -> list[Shown]:
    """The cases that are to be drawn.  Raises Refused for a name that none has."""
    if PAGES in words:
        return []
    if MISSING in words:
        return [one for one in shown if not one.film.exists()]
    by_name = {one.name: one for one in shown}
    for word in words:
        if word not in by_name:
            raise Refused(f"gallery {word}: no such case; give a name below run/cases, such as minimal")
    return [by_name[word] for word in words] or shown


def main(words: Sequence[str]) -> int:
    """The exit code: 2 if something could not be drawn; the others are drawn all the same."""
    failures = 0
    try:
        shown = every()
        wanted = chosen(shown, words)
    except Refused as error:
        print(error, file=sys.stderr)
        return 2
    for one in wanted:
        try:
            print(draw(one), flush=True)
        except Refused as error:
            failures += 1
            print(f"{one.name}: {error}", file=sys.stderr, flush=True)
    pages.write(shown)
    print(f"wrote {pages.INDEX}")
    return 2 if failures else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
