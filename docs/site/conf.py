"""Settings of the generator of the documentation site, for `scripts/build_site.py`."""

from __future__ import annotations

import re
from importlib.metadata import version as installed
from itertools import count

from camwright.reports.figure_svg import COLOURS, DARK

project = "Camwright"
author = "the developers of Camwright"
copyright = "the developers of Camwright, GPL-3.0-or-later"  # noqa: A001
version = release = installed("camwright")
language = "en"

extensions = ["myst_parser"]
source_suffix = {".md": "markdown"}
myst_enable_extensions = ["colon_fence"]
myst_heading_anchors = 5
nitpicky = True
smartquotes = False
pygments_style = "camwright_colours.Light"
pygments_dark_style = "camwright_colours.Dark"

html_theme = "furo"
html_title = "Camwright"
html_logo = "static/cam.svg"
html_favicon = "static/cam.svg"
html_static_path = ["static"]
html_css_files = ["site.css"]
html_js_files = [("site.js", {"defer": "defer"})]
html_copy_source = False
html_show_sourcelink = False
html_show_sphinx = False
toc_object_entries = False
html_use_index = True
html_last_updated_fmt = None
html_permalinks_icon = "#"

_SHARED = {
    "font-stack": 'system-ui, "Segoe UI", Roboto, "Helvetica Neue", Arial, sans-serif',
    "font-stack--monospace": "ui-monospace, SFMono-Regular, Menlo, Consolas, monospace",
}
html_theme_options = {
    "navigation_with_keys": True,
    "light_css_variables": _SHARED | COLOURS | {
        "color-brand-primary": "#005a8d", "color-brand-content": "#005a8d",
        "color-brand-visited": "#5b3f8c",
        "color-foreground-muted": "#59616b", "color-foreground-secondary": "#48505a",
        "camwright-2": "#00694d", "camwright-steel": "#dfe4ea", "camwright-fixed": "#8f98a3",
        "camwright-cam": "#b9d7ec", "camwright-line": "#1b1f24",
    },
    "dark_css_variables": _SHARED | DARK | {
        "color-brand-primary": "#7cc4f5", "color-brand-content": "#7cc4f5",
        "color-brand-visited": "#c3b1e8",
        "color-foreground-muted": "#a0a8b2", "color-foreground-secondary": "#b3bac3",
        "camwright-2": "#35c89c", "camwright-steel": "#3c4652", "camwright-fixed": "#707b88",
        "camwright-cam": "#24506e", "camwright-line": "#e6e9ed",
    },
}  # fmt: skip


def _reachable(body: str) -> str:
    """A page whose scrolled blocks are reached by the keyboard."""
    numbers = count(1)
    return re.sub(
        r'<div class="table-wrapper([^"]*)">',
        lambda match: (
            f'<div class="table-wrapper{match[1]}" tabindex="0" role="region" '
            f'aria-label="table {next(numbers)}">'
        ),
        body.replace("<pre>", '<pre tabindex="0">'),
    )


def setup(app: object) -> None:
    """Change the parts of each page before its template is filled."""

    def page(_app: object, _page: str, _template: str, context: dict, _doctree: object) -> None:
        if "body" in context:
            context["body"] = _reachable(context["body"])
        tree = context.get("furo_navigation_tree", "")
        context["furo_navigation_tree"] = tree.replace(' role="heading"', "")

    app.connect("html-page-context", page, priority=900)  # after the theme has wrapped the tables
