"""The documentation site: it builds without a warning, and no link in it leads nowhere."""

import re
import subprocess
import sys
from html import unescape
from pathlib import Path
from urllib.parse import unquote, urlsplit

import pytest
from jobs import clean_environment

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT / "docs/site"))

import figures  # noqa: E402
import navigation  # noqa: E402
import plain  # noqa: E402
import tree  # noqa: E402


def build(source, out):
    """The strict build of run/site."""
    return subprocess.run(
        [
            sys.executable,
            "-m",
            "sphinx",
            "-c",
            str(ROOT / "docs"),
            "-b",
            "html",
            "-W",
            "--keep-going",
            "-q",
            ".",
            str(out),
        ],
        cwd=source,
        env=clean_environment(),
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=170,
    )


@pytest.fixture(scope="module")
def pages(tmp_path_factory):
    """The committed pages and the generated ones."""
    folder = tmp_path_factory.mktemp("site") / "pages"
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(ROOT)
        tree.make(folder)
    return folder


@pytest.fixture(scope="module")
def site(pages):
    out = pages.parent / "out"
    job = build(pages, out)
    assert job.returncode == 0, job.stderr
    return out


def test_generated_pages_stand_beside_the_committed_ones(pages):
    for name, text in tree.GENERATED.items():
        page = (pages / name).read_text(encoding="utf-8")
        assert page == f"{(ROOT / name).read_text(encoding='utf-8')}\n{text()}" and len(page) > 9_000
    cases = {path.relative_to(ROOT / "run/cases") for path in (ROOT / "run/cases").rglob("*.toml")}
    made = {path.relative_to(pages / "docs/gallery") for path in (pages / "docs/gallery").rglob("*.md")}
    assert made == {case.with_suffix(".md") for case in cases} | {Path("index.md")}


@pytest.mark.landing
def test_every_page_is_there_and_is_found(site, pages):
    names = navigation.pages_of(pages)
    assert all((site / f"{name}.html").exists() for name in names) and len(names) > 100
    index = (site / "searchindex.js").read_text(encoding="utf-8")
    assert all(f'"{name}"' in index for name in names)
    assert navigation.TOP in (site / "index.html").read_text(encoding="utf-8")


def links(html):
    return [unescape(link) for link in re.findall(r'\b(?:href|src)="([^"]*)"', html)]


def missing(site, page):
    """The local links of a page that lead nowhere."""
    found = []
    for link in links(page.read_text(encoding="utf-8")):
        parts = urlsplit(link)
        if parts.scheme:
            continue
        target = (page.parent / unquote(parts.path)).resolve() if parts.path else page
        if not target.exists():
            found.append(link)
        elif parts.fragment and target.suffix == ".html":
            if f'id="{unquote(parts.fragment)}"' not in target.read_text(encoding="utf-8"):
                found.append(link)
    return found


def test_links_of_the_site_lead_somewhere(site):
    pages = [path for path in site.rglob("*.html") if "_static" not in path.parts]
    assert {str(page): missing(site, page) for page in pages if missing(site, page)} == {}


def test_the_site_loads_nothing_from_elsewhere(site):
    text = "\n".join(path.read_text(encoding="utf-8") for path in site.rglob("*.html"))
    loaded = re.findall(r'<(?:script|img|link)\b[^>]*\b(?:src|href)="(https?:[^"]*)"', text)
    assert not loaded


def test_the_reference_has_every_effect_with_its_parameters(site):
    page = (site / "docs/api/effects.html").read_text(encoding="utf-8")
    assert "A particle at a free surface feels no pressure." in page
    assert "below this kernel sum a particle is surface" in page
    assert "case_text" in (site / "docs/api/results.html").read_text(encoding="utf-8")


def test_a_link_that_leads_nowhere_stops_the_build(tmp_path):
    """The control, on a site of one page."""
    (tmp_path / "docs").mkdir()
    (tmp_path / "docs/index.md").write_text("# One\n\n## Part\n\n- [no](gone.md)\n", encoding="utf-8")
    job = build(tmp_path, tmp_path / "out")
    assert job.returncode != 0 and "gone" in job.stderr


def test_a_page_that_no_list_has_comes_last():
    text = "# psph\n\n## First\n\n- [a](a.md)\n\n## Second\n\n- [g](g/index.md), [b](../README.md)\n"
    pages = ["README", "docs/a", "docs/g/index", "docs/g/x", "docs/index", "docs/new"]
    found = navigation.parts(text, pages)
    assert found == {"First": ["docs/a"], "Second": ["docs/g/index", "README"], "More": ["docs/new"]}
    assert list(found)[-1] == navigation.REST


def test_an_index_lists_the_pages_of_its_folder_in_the_order_of_its_links():
    pages = ["docs/g/a", "docs/g/b", "docs/g/c/d", "docs/g/index", "docs/h"]
    assert navigation.below("docs/g/index", "[b](b.md) [h](../h.md)", pages) == [
        "docs/g/b",
        "docs/g/a",
        "docs/g/c/d",
    ]


def test_figures_are_drawn_and_shown(tmp_path):
    drawn = figures.draw(tmp_path)
    pages = "\n".join(path.read_text(encoding="utf-8") for path in (ROOT / "docs").glob("*.md"))
    for path in drawn:
        assert path.read_bytes()[:4] == b"\x89PNG"
        assert (ROOT / "docs/images" / path.name).exists() and f"(images/{path.name})" in pages


def test_no_page_is_listed_twice_or_gone():
    index = (ROOT / "docs/index.md").read_text(encoding="utf-8")
    pages = navigation.pages_of(ROOT)
    found = [page for group in navigation.parts(index, pages).values() for page in group]
    assert len(found) == len(set(found)) and set(found) <= set(pages)


@pytest.mark.parametrize(
    ("text", "rst", "markdown"),
    [
        ("|v| of ρ_i*", r"\|v\| of ρ_i\*", r"\|v\| of ρ\_i\*"),
        ("see ``a|b``", "see ``a|b``", "see `a|b`"),
        (":class:`X` is", ":class:`X` is", "`X` is"),
    ],
)
def test_signs_of_docstrings_are_no_markup(text, rst, markdown):
    assert (plain.escaped(text), plain.markdown(text)) == (rst, markdown)
