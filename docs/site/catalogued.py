"""``{catalogue}``: what a case can switch on, each with the docstring of its class and its parameters."""

import inspect
from collections.abc import Iterator
from typing import get_type_hints

from plain import markdown
from pydantic.fields import FieldInfo
from sphinx.util.docutils import SphinxDirective

from psph import smoothing
from psph.physics.catalogue import BUILT_IN, Entry

KINDS = {
    "effects": lambda: BUILT_IN.effects,
    "states": lambda: BUILT_IN.states,
    "kernels": lambda: [Entry(f"space.kernel={name}", kind) for name, kind in smoothing.KERNELS.items()],
}
ALWAYS = "always on"


def described(entry: Entry, level: int) -> Iterator[str]:
    """The Markdown of one entry."""
    kind = entry.effect
    key, _, choice = entry.key.partition("=")
    named = f'`{key} = "{choice}"`' if choice else f"`{key}`" if key else ALWAYS
    yield f"{'#' * level} {kind.__name__}\n"
    yield f"{named}, in `{kind.__module__}`.\n"
    yield markdown(inspect.getdoc(kind) or "")
    yield ""
    yield from _parameters(kind)


def _parameters(kind: type) -> Iterator[str]:
    hints = get_type_hints(kind, include_extras=True)
    rows = []
    for name in getattr(kind, "_fields", ()):
        about = next((m for m in getattr(hints[name], "__metadata__", ()) if isinstance(m, FieldInfo)), None)
        if about is not None:
            extra = about.json_schema_extra if isinstance(about.json_schema_extra, dict) else {}
            default = getattr(kind, "_field_defaults", {}).get(name, "required")
            said = f"`{default}`" if default != "required" and default is not None else default or ""
            rows.append(
                f"| `{name}` | {said} | {extra.get('unit', '')} | {markdown(about.description or '')} |"
            )
    if rows:
        yield "| parameter | default | unit | meaning |\n|---|---|---|---|"
        yield from rows
        yield ""


class Catalogued(SphinxDirective):
    """All entries of a kind, by rooms of ``psph/physics``."""

    required_arguments = 1

    def run(self) -> list:
        """The nodes."""
        lines: list[str] = []
        for entry in KINDS[self.arguments[0]]():
            lines += described(entry, 2)
        return self.parse_text_to_nodes("\n".join(lines), allow_section_headings=True)


def setup(app) -> dict:
    """For Sphinx."""
    app.add_directive("catalogue", Catalogued)
    return {"parallel_read_safe": True}
