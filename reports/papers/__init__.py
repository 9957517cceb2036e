"""Pages of the papers: figures, and verdicts on published values. Nothing is solved.

In the order of use:

| module            | responsibility                                          |
| ----------------- | ------------------------------------------------------- |
| `paper_chart`     | a figure of a paper as SVG                              |
| `papers_page`     | ``papers.html``: figures beside the published values    |
| `validation_page` | ``validation.html``: values, verdicts, basis, figures   |
| `gallery_page`    | ``gallery.html``: machines and their cams               |

Imported by `commands`.
"""
