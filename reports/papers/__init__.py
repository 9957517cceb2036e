"""Page of the figures of the papers, from their data. Nothing is solved.

In the order of use:

| module        | responsibility                                          |
| ------------- | ------------------------------------------------------- |
| `paper_chart` | a figure of a paper as SVG                              |
| `papers_page` | ``papers.html``: figures beside the published values    |

Imported by `commands`.
"""
