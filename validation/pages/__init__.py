"""Pages of validation: published values and figures, machines, mechanisms. Nothing is solved.

In the order of use:

| module              | responsibility                                                       |
| ------------------- | -------------------------------------------------------------------- |
| `paper_chart`       | a figure of a paper from its record                                  |
| `figures_page`      | ``figures.html``: figures beside the published values                |
| `values_page`       | ``values.html``: values, verdicts, basis, figures                    |
| `gallery_page`      | ``gallery.html``: machines and their cams                            |
| `mechanism_figures` | slider-crank and eccentric cams: friction energy, torque, workspaces |
"""
