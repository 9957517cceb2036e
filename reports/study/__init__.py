"""Page of a study, from its answers and designs. Nothing is solved.

In the order of use:

| module           | responsibility                                               |
| ---------------- | ------------------------------------------------------------ |
| `study_contents` | yield, failures, effects, front and inputs as text and bars  |
| `study_page`     | ``study.html``: contents, designs with linked selection      |
| `design_picture` | ``design.png``: torque, front, cam and parts of a design     |

Imported by `commands`.
"""
