"""The documentation site: `./run/site` builds it from the pages of docs/site/tree.py."""

import sys
from pathlib import Path

HERE = Path(__file__).parent
sys.path[:0] = [str(HERE / "site"), str(HERE.parent)]

from psph import __version__  # noqa: E402

project = "psph"
author = "the psph developers"
copyright = "the psph developers, BSD 3-Clause"
release = __version__

extensions = ["myst_parser", "sphinx.ext.autodoc", "navigation", "catalogued", "plain"]
root_doc = "docs/index"
include_patterns = ["README.md", "CHANGELOG.md", "docs/**"]
exclude_patterns = ["docs/images", "docs/gallery/images", "psph", "run", "tests"]

myst_heading_anchors = 4
suppress_warnings = ["misc.highlighting_failure"]  # outputs stand in blocks that no language reads

autodoc_member_order = "bysource"
autodoc_typehints = "signature"
autodoc_preserve_defaults = True

html_theme = "sphinx_book_theme"
html_title = f"psph {release}"
html_theme_options = {"show_navbar_depth": 1, "home_page_in_toc": True, "use_download_button": False}
html_show_sourcelink = False
html_copy_source = False
html_static_path: list[str] = []
