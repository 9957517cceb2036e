"""Validation, in the checkout alone: published values and figures, recomputed; mechanisms.

``python -m validation`` runs it.

In the order of the calculation:

| module                    | responsibility                                 | symbol, unit   |
| ------------------------- | ---------------------------------------------- | -------------- |
| `published_figures`       | targets, outcomes, verdicts                    |                |
| `paper_figure`            | figure of a paper: curves, caption, values     |                |
| `paper_engines`           | engines of the papers in the cylinder model    | N m            |
| `balancing_cam`           | balancing cam under an engine torque           | N m; rad/s     |
| `follower_contours`       | roller and flat faces for the same torque      | m; N; Pa       |
| `speed_reconstruction`    | crank speed from published statistics          | rad/s          |
| `validation_figures`      | curves behind the rows of `values`             |                |
| `cardoso_2024`            | engine at 800 rpm, cam without losses          |                |
| `cardoso_2025`            | engine at idle and its balancing cam           |                |
| `petrescu_2015`           | valve cams of modules B and C                  |                |
| `slider_crank_drive`      | slider-crank and eccentric cam: forces, losses | N; J           |
| `mechanism_sizes`         | friction energy over the sizes                 | J              |
| `slider_crank_2024`       | slider-crank and eccentric cam                 |                |
| `friction_identification` | friction from measured decays                  | N m; N m s/rad |
| `mechanism_comparison`    | `mechanisms`: slider-crank and eccentric cams  |                |
| `modelled_runs`           | ten runs at a pick-up, from voltage to speed   | V; rad/s       |
| `figures_2025_engine`     | engine, pick-up and ten runs of three states   | N m; rad/s     |
| `figures_2025_cam`        | smoothing, outlines, friction, preloads        | N m; rad/s; mm |
| `figures_2024_cam`        | engine at 800 rpm with and without the cam     | N m; rad/s; mm |
| `figures_2015_valve`      | valve cams: outlines, shape index, dynamics    | mm; m/s2       |
| `figures_2024_mechanisms` | slider-crank and eccentric cam                 | N; J           |
| `paper_studies`           | values and figures of all papers               |                |
| `machine_gallery`         | `gallery`: machines and their cams             | N m; mm; rpm   |
| `pages`                   | pages and pictures; nothing is solved          |                |
| `__main__`                | command line                                   |                |
"""
